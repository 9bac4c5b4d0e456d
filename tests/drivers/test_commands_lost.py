"""What the host sends does not reach the drive, while all else goes on: it is taken off another way, or by itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import can
import pytest

from rig.core.errors import NotReady
from rig.core.sample import Torque
from rig.drill.canopen_rig import CanopenRig
from rig.drill.odrive_rig import ODriveRig
from rig.drill.rig import DrillRig
from rig.supervisor import UNCONFIRMED, Act, State
from sim.wire.faults.of_bus import BusFaults
from tests.drivers.running import SHORT

COMMANDS, QUESTIONS, NMT = 0x201, 0x601, 0x000  # of the drive: its RPDO 1, its SDO, and what all hear


def without(*identifiers: int) -> CanopenRig:
    """A rig after a run in which those frames were lost from 0.3 s on, for good."""
    rig = CanopenRig()
    faults = BusFaults(rig.assembly.bus)
    for identifier in identifiers:
        rig.assembly.agenda.after(0.3, lambda identifier=identifier: faults.drop(identifier))
    ending = rig.run(SHORT)
    assert ending.status == "tripped"
    assert rig.supervisor.state is State.FAULT
    assert not rig.energised, "by SDO, or by its own watchdog, which stayed armed and nothing feeds"
    return rig


def test_a_drive_that_takes_no_controlword_any_more_is_taken_off_by_sdo() -> None:
    rig = without(COMMANDS)
    assert rig.instruments.safe()
    rig.close()


@pytest.mark.parametrize("lost", [(COMMANDS, QUESTIONS), (COMMANDS, QUESTIONS, NMT)], ids=["NMT stop", "watchdog"])
def test_a_drive_that_cannot_be_reached_goes_off_by_itself_and_is_not_reset(lost: tuple[int, ...]) -> None:
    rig = without(*lost)
    with pytest.raises(NotReady):
        rig.instruments.drive.reset_fault()
    assert rig.instruments.drive.bus.mute, "a reset that failed feeds nothing either"  # type: ignore[attr-defined]
    for _ in range(30):  # what a console does between runs: it goes on to read
        rig.instruments.look()
    assert not rig.energised
    assert rig.supervisor.state is State.FAULT
    rig.close()


@pytest.mark.slow
def test_a_drive_that_went_off_by_itself_can_be_used_again() -> None:
    rig = CanopenRig()
    faults = BusFaults(rig.assembly.bus)
    for identifier in (COMMANDS, QUESTIONS):
        rig.assembly.agenda.after(0.3, lambda identifier=identifier: faults.drop(identifier))
    assert rig.run(SHORT).status == "tripped"
    faults.heal()
    rig.instruments.drive.reset_fault()
    rig.supervisor.act(Act.RESET)
    assert not rig.energised
    rig.supervisor.act(Act.CHECK)
    assert rig.run(SHORT).status == "completed"
    rig.close()


def test_a_drive_that_was_left_alone_and_says_that_it_is_off_can_be_enabled() -> None:
    rig = CanopenRig()
    drive: Any = rig.instruments.drive
    drive._leave_alone()
    for _ in range(10):
        rig.instruments.look()
    assert drive.halt() is True
    drive.enable()
    assert rig.energised
    assert not drive.bus.mute
    for _ in range(20):  # 0.4 s: its watchdog is fed
        rig.instruments.look()
        rig.instruments.write(Torque(0.0))
    assert rig.energised
    assert drive.halt() is True
    assert not rig.energised
    rig.close()


@pytest.mark.parametrize("made", [CanopenRig, ODriveRig])
@pytest.mark.parametrize("way", ["send", "recv", "flush_tx_buffer", "shutdown"])
def test_whatever_an_adapter_raises_halting_and_closing_twice_do_not(
    made: Callable[[], DrillRig], way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = made()

    def broken(*_: object, **__: object) -> None:
        raise OSError(19, "No such device")

    drive = rig.instruments.drive
    monkeypatch.setattr(drive.bus.raw, way, broken)  # type: ignore[attr-defined]
    assert drive.halt() in (True, False)
    assert drive.halt() in (True, False)
    drive.close()
    drive.close()


@pytest.mark.parametrize("error", [BrokenPipeError(32, "Broken pipe"), can.CanError("gone")])
def test_an_adapter_that_fails_in_the_middle_of_a_halt_raises_nothing(error: Exception) -> None:
    rig = CanopenRig()

    def broken(*_: object, **__: object) -> None:
        raise error

    rig.assembly.agenda.after(0.3, lambda: setattr(rig.instruments.drive.bus.raw, "send", broken))
    ending = rig.run(SHORT)
    assert ending.status == "tripped"
    assert UNCONFIRMED in ending.reason
    assert rig.supervisor.state is State.FAULT
    assert rig.instruments.safe() is False
