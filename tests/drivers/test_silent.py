"""One message that stays away while the others come: which it is, latched until it comes again and somebody resets."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from drivers.silence import missing
from rig.core.errors import NotReady
from rig.drill.canopen_rig import CanopenRig
from rig.drill.odrive_causes import ESTIMATES, TORQUES
from rig.drill.odrive_rig import ODriveRig
from rig.drill.rig import DrillRig
from rig.supervisor import Act, State
from sim.wire.faults.of_bus import BusFaults
from tests.drivers.running import SHORT

ODRIVE = [
    (ESTIMATES, "no new motor sample", "its position (0x09) stays away while its torque (0x1C) comes"),
    (TORQUES, "no new motor sample", "its torque (0x1C) stays away while its position (0x09) comes"),
]
CANOPEN = [
    (0x181, "no new motor sample", "frame 0x181 stays away while frame 0x281 comes"),
    (0x281, "no new motor sample", "frame 0x281 stays away while frame 0x181 comes"),
    (0x182, "no new load-encoder sample", ""),
    (0x183, "no new torque-sensor sample", ""),
]


def _silenced(rig: DrillRig, faults: BusFaults, identifier: int, words: str, which: str) -> None:
    """A run in which one kind of frame is lost for good ends in a fault, which a reset leaves once they come again."""
    rig.assembly.agenda.after(0.3, lambda: faults.drop(identifier))
    ending = rig.run(SHORT)
    assert ending.status == "tripped"
    assert words in ending.reason
    assert which in ending.reason
    assert rig.supervisor.state is State.FAULT
    assert not rig.energised
    with pytest.raises(NotReady):
        _reset(rig)
    assert rig.supervisor.state is State.FAULT, "it is silent still"
    faults.heal()
    rig.wire.wait_until(rig.wire.now() + 0.2)
    assert rig.supervisor.state is State.FAULT, "its coming back is no reset"
    _reset(rig)
    assert rig.supervisor.state is State.CONNECTED
    assert not rig.energised


def _reset(rig: DrillRig) -> None:
    """As a session does it."""
    rig.instruments.drive.reset_fault()
    for device in rig.instruments.devices:
        device.clear()
    rig.supervisor.act(Act.RESET)


@pytest.mark.parametrize(("identifier", "words", "which"), ODRIVE, ids=["position", "torque"])
def test_of_an_odrive_the_one_message_that_stays_away_is_named(identifier: int, words: str, which: str) -> None:
    rig = ODriveRig()
    _silenced(rig, BusFaults(rig.bus), identifier, words, f"of drive (ODrive node 5 on CAN bus 'drive') {which}")
    rig.close()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("identifier", "words", "which"), CANOPEN, ids=["status", "motor position", "load encoder", "torque sensor"]
)
def test_of_canopen_devices_the_one_frame_that_stays_away_is_named(identifier: int, words: str, which: str) -> None:
    rig = CanopenRig()
    _silenced(rig, BusFaults(rig.assembly.bus), identifier, words, which)
    rig.close()


@pytest.mark.parametrize("made", [ODriveRig, CanopenRig])
def test_a_device_that_is_gone_as_a_whole_is_not_said_to_tell_half(made: Callable[[], DrillRig]) -> None:
    rig = made()
    faults = BusFaults(rig.bus if isinstance(rig, ODriveRig) else rig.assembly.bus)
    rig.assembly.agenda.after(0.3, lambda: faults.cut())
    ending = rig.run(SHORT)
    rig.close()
    assert ending.status == "tripped"
    assert "stays away" not in ending.reason


def test_a_frame_or_two_that_are_lost_are_no_silence() -> None:
    assert missing({"a": 1.0, "b": 1.002}, 0.001) == ""
    assert missing({"a": 1.0, "b": 1.003, "c": 1.003}, 0.001) == "a stays away while b and c comes"
    assert missing({"a": 1.0}, 0.001) == missing({}, 0.001) == ""
