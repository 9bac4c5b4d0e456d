"""The hard-wired chain is shown as far as the drive tells, and never faked."""

from __future__ import annotations

from rig.station.chain import Chain


def test_a_drive_that_tells_nothing_leaves_it_unknown() -> None:
    said = Chain().judge(None, energised=False)
    assert (said["known"], said["closed"]) == (False, None)


def test_voltage_is_a_closed_chain() -> None:
    said = Chain().judge(True, energised=False)
    assert (said["known"], said["closed"]) == (True, True)


def test_a_drive_that_tells_voltage_while_it_is_off_is_believed_when_it_is_gone() -> None:
    chain = Chain()
    chain.judge(True, energised=False)
    said = chain.judge(False, energised=True)
    assert (said["known"], said["closed"]) == (True, False)


def test_a_drive_that_tells_voltage_only_while_energised_says_nothing_when_it_is_off() -> None:
    chain = Chain()
    chain.judge(True, energised=True)
    said = chain.judge(False, energised=False)
    assert (said["known"], said["closed"]) == (False, None)
