"""From a bench file to devices: never a mixture, never a device that does not exist, SI inside."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import drivers
from rig.bench import read
from rig.core.clock import WallClock
from rig.core.errors import UsageError
from sim.world import World


def test_the_limits_are_si_and_the_gains_know_the_torque_limit() -> None:
    bench = read("twin")
    assert bench.limits.speed == pytest.approx(600 * math.pi / 30)
    assert bench.limits.travel == pytest.approx(400 * 2 * math.pi)
    assert bench.gains.torque_limit == 5.0


def test_an_override_changes_one_number_says_so_and_keeps_the_rest() -> None:
    bench = read("twin", ["control.Kp=4", "gear.serial=SN7"])
    assert (bench.file.control.Kp, bench.file.gear.serial) == (4.0, "SN7")
    assert 'Kp = { value = 4, unit = "N·m/rad", from = "declared" }' in bench.text
    assert bench.file.gear == read("twin").file.gear.model_copy(update={"serial": "SN7"})


def test_a_twin_over_a_wire_that_is_not_there_is_said_to_be_startable(tmp_path: Path) -> None:
    control, port = tmp_path / "control", tmp_path / "serial" / "torque"
    bench = read("twin-can", [f"hand.control={control}", f"devices.torque_sensor.port={port}"])
    port.parent.mkdir()
    for door in (control, port):
        assert f"`hdrig twin --serial {port.parent}`" in bench.twin_not_there
        door.touch()
    assert bench.twin_not_there == ""
    assert read("twin").twin_not_there == ""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("assignments", "words"),
    [
        (["devices.drive.type=twin.driv"], ["no such device", "did you mean 'twin.drive'"]),
        (["devices.load_encoder.type=cia406"], ["real and simulated devices on one bench"]),
        (["limits.shaft_torque=60"], ["60 N·m", "range of 50 N·m"]),
        (["nothing.here=1"], ["no section 'nothing'"]),
        (["gear.ratio=80"], ["no key 'gear.ratio'", "did you mean 'gear.N'?"]),
        (["devices.load_encoder.type=twin.drive"], ["that device is no load encoder"]),
        (["loop.rate=20"], ["watchdog", "three periods"]),
        (["control.Kp.value.x=5"], ["no key"]),
        (["control.Kp=1" + "0" * 400], ["digits"]),
        (["limits.torque=1", "limits.torque=4"], ["limits.torque was set to 1 before; expected once"]),
        (["twin.friction_noise_s=1e-30"], ["friction_noise_s", "0.001"]),
    ],
)
def test_what_cannot_be_is_refused(assignments: list[str], words: list[str]) -> None:
    with pytest.raises(UsageError) as refusal:
        read("twin", assignments).open("virtual")
    for word in words:
        assert word in str(refusal.value)


@pytest.mark.parametrize(
    ("name", "assignments", "words"),
    [
        ("twin-canopen", ["devices.drive.bus=rigg"], ["devices.drive.bus = 'rigg': no such bus", "has rig"]),
        ("twin-canopen", ["devices.load_encoder.node=1"], ["two devices are node 1 on bus 'rig'"]),
        ("twin-odrive", ["devices.torque_sensor.port=/tmp/hdrig-twin/serial/qsb"], ["two devices are on port /tmp/"]),
    ],
)
def test_a_place_that_is_not_there_or_taken_is_refused_as_soon_as_the_file_is_read(
    name: str, assignments: list[str], words: list[str]
) -> None:
    with pytest.raises(UsageError) as refusal:
        read(name, assignments)
    for word in words:
        assert word in str(refusal.value)


@pytest.mark.parametrize(
    ("name", "role", "line", "words"),
    [
        (
            "twin-canopen",
            "load_encoder",
            "watchdog = 0.2",
            "load_encoder.watchdog means nothing to a can.cia406",
        ),
        ("twin-odrive", "load_encoder", 'bus = "rig"', "it has type, port, baud, direction, delay"),
        ("twin", "drive", "direction = -1", "devices.drive.direction means nothing to a twin.drive; it has type"),
    ],
)
def test_a_key_of_another_kind_of_device_is_refused_and_not_passed_over(
    name: str, role: str, line: str, words: str, tmp_path: Path
) -> None:
    section = f"[devices.{role}]\n"
    (tmp_path / "b.toml").write_text(read(name).text.replace(section, f"{section}{line}\n"), encoding="utf-8")
    with pytest.raises(UsageError, match=words):
        read(str(tmp_path / "b.toml"))


def test_the_clock_is_the_world_or_the_wall_and_never_virtual_on_real_devices(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert isinstance(read("twin").open("virtual").clock, World)
    assert isinstance(read("twin").open("wall").clock, WallClock)
    monkeypatch.setattr(drivers, "CATALOGUE", {"real.drive": "sim.drive:TwinDrive"})
    text = read("twin").text.replace('"twin.drive"', '"real.drive"')
    text = text.replace('[devices.load_encoder]\ntype = "twin.load_encoder"\n', "")
    text = text.replace('[devices.torque_sensor]\ntype = "twin.torque_sensor"\n', "")
    (tmp_path / "real.toml").write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match="only on the twin"):
        read(str(tmp_path / "real.toml")).open("virtual")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("devices.load_encoder.node=1", r"two devices are node 1 on bus 'rig'"),
        ("loop.latch_lead=0.6", r"latch_lead = 0.6 s is no shorter than the period of 0.001 s"),
        ("loop.rate=250,devices.drive.watchdog=0.01", r"a watchdog of 0.01 s is under three periods"),
        ("devices.drive.watchdog=0.05", r"devices.drive.watchdog = 0.05 s is no longer than limits.stale_s = 0.1 s"),
        ("limits.stale_s=0.15", r"watchdog = 0.15 s is no longer than limits.stale_s = 0.15 s.*expected a longer"),
        ("limits.stale_s=100", r"stale_s = 100.* s: expected less than or equal to 1"),
    ],
)
def test_numbers_that_do_not_go_together_are_refused(change: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        read("twin-can", change.split(","))
