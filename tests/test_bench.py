"""From a bench file to devices: never a mixture, never a device that does not exist, SI inside."""

from __future__ import annotations

import math

import pytest

from rig.bench import read
from rig.core.clock import WallClock
from rig.core.errors import UsageError
from sim.world import World


def test_the_limits_are_si_and_the_gains_know_the_torque_limit() -> None:
    bench = read("twin")
    assert bench.limits.speed == pytest.approx(600 * math.pi / 30)
    assert bench.limits.travel == pytest.approx(60 * 2 * math.pi)
    assert bench.gains.torque_limit == 5.0


def test_an_override_changes_one_number_says_so_and_keeps_the_rest() -> None:
    bench = read("twin", ["control.Kp=4", "gear.serial=SN7"])
    assert (bench.file.control.Kp, bench.file.gear.serial) == (4.0, "SN7")
    assert 'Kp = { value = 4, unit = "N·m/rad", from = "declared" }' in bench.text
    assert bench.file.gear == read("twin").file.gear.model_copy(update={"serial": "SN7"})


@pytest.mark.parametrize(
    ("assignments", "words"),
    [
        (["devices.drive.type=twin.driv"], ["no such device", "did you mean 'twin.drive'"]),
        (["devices.load_encoder.type=cia406"], ["real and simulated devices on one bench"]),
        (["limits.shaft_torque=60"], ["60 N·m", "range of 50 N·m"]),
        (["nothing.here=1"], ["no section 'nothing'"]),
    ],
)
def test_what_cannot_be_is_refused(assignments: list[str], words: list[str]) -> None:
    with pytest.raises(UsageError) as refusal:
        read("twin", assignments).open("virtual")
    for word in words:
        assert word in str(refusal.value)


def test_the_clock_is_the_world_or_the_wall_and_never_virtual_on_real_devices() -> None:
    assert isinstance(read("twin").open("virtual").clock, World)
    assert isinstance(read("twin").open("wall").clock, WallClock)
    real = ["devices.drive.type=x", "devices.load_encoder.type=x", "devices.torque_sensor.type=x"]
    with pytest.raises(UsageError, match="only on the twin"):
        read("twin", real).open("virtual")
