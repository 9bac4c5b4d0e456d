"""What no bench should be asked for is refused before anything moves; a dry run tells, and writes nothing."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from rig.bench import read
from rig.campaign.dry_run import figures, lines
from rig.campaign.swing import resonance_speed, swing
from rig.cli import main
from rig.core.errors import NotReady, UsageError
from tests.campaign.plans import HEAD, LOADED, LOCKED, REST, campaign, turning

LOCK_TEST = '\n[[step]]\nprocedure = "stiffness-lock"\nwith = { tau_max = %g }\n'


@pytest.mark.parametrize(
    ("step", "words"),
    [
        (turning(590), ["590", "678.5 rpm", "bench allows 600 rpm"]),
        (REST + "weight = 46.0\n", ["+46 N·m", "bench allows 45 N·m"]),
        (LOCK_TEST % 40.0, ["stiffness-lock", "bench allows 45 N·m"]),
        ('\n[[step]]\nprocedure = "kinematic-error"\nwith = { amplitude_deg = 1e6 }\n', ["travel", "1e+06 deg"]),
    ],
)
def test_more_than_the_bench_allows_is_refused_with_both_numbers(step: str, words: list[str]) -> None:
    with pytest.raises(NotReady) as refused:
        campaign(step)
    for word in words:
        assert word in str(refused.value)


def fast() -> object:
    return read("twin", ["limits.speed_rpm=1500", "limits.travel_turns=2000"])


@pytest.mark.slow
def test_a_run_into_the_resonance_of_order_2_is_refused_with_speed_and_swing() -> None:
    with pytest.raises(NotReady) as refused:
        campaign(turning(700), bench=fast())  # type: ignore[arg-type]
    for word in ("resonance at 755 rpm", "805 rpm", "allow_resonance = true", "N·m"):
        assert word in str(refused.value)


@pytest.mark.parametrize("how", [[], ["--dry-run"]])
def test_a_single_run_into_the_resonance_is_refused_as_well(
    how: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ["run", "constant-torque", "--with", "speed_rpm=700", "--set", "limits.speed_rpm=1500"]
    asked += ["--set", "limits.travel_turns=2000", "--out", str(tmp_path / "runs"), *how]
    assert main(asked) == 3
    said = capsys.readouterr()
    for word in ("resonance at 755 rpm", "805 rpm", "--allow-resonance", "±26.3 N·m"):
        assert word in said.err
    assert not (tmp_path / "runs").exists()
    assert ("predicted   the shaft torque swings by ±26.30 N·m" in said.out) is bool(how)


@pytest.mark.slow
def test_a_single_run_through_the_resonance_can_be_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["run", "constant-torque", "--with", "speed_rpm=700", "--set", "limits.speed_rpm=1500", "--dry-run"]
    assert main([*asked, "--allow-resonance"]) == 0
    assert main(["run", "stiffness-lock", "--dry-run"]) == 0
    assert "swings" not in capsys.readouterr().out.split("stiffness-lock", 1)[1], "a locked output swings nowhere"


def test_it_is_made_where_the_plan_allows_it_and_the_swing_stays_within_the_sensor() -> None:
    found = campaign(turning(700, "allow_resonance = true"), bench=fast())  # type: ignore[arg-type]
    assert 20.0 < found.swing(found.items[0]) < 45.0


def test_a_weight_and_a_swing_that_together_go_beyond_the_sensor_are_refused() -> None:
    with pytest.raises(NotReady, match="of it swing"):
        campaign(turning(700, "allow_resonance = true", "weight = 20.0"), bench=fast())  # type: ignore[arg-type]


def test_the_resonance_is_where_the_declared_inertias_and_stiffness_put_it() -> None:
    gear = read("twin").declared_gear
    inertia = 1 / (1 / 0.32 + 1 / (2500 * 1.1e-3))
    assert resonance_speed(gear) == pytest.approx(math.sqrt(7160 / inertia) / 2, rel=1e-12)


def test_well_below_the_resonance_the_swing_grows_with_the_square_of_the_speed() -> None:
    gear = read("twin").declared_gear
    slow, faster = swing(gear, 1e-4, 2.0), swing(gear, 1e-4, 4.0)
    assert faster / slow == pytest.approx(4.0, rel=0.01)
    # the load follows the error: its inertia times the acceleration of the error, J_e·(2Ω)²·C_2
    inertia = 1 / (1 / gear.J_l + 1 / (gear.ratio**2 * gear.J_m))
    assert slow == pytest.approx(inertia * (2 * 2.0) ** 2 * 1e-4, rel=0.01)


def test_a_weight_without_a_torque_sensor_is_refused(tmp_path: Path) -> None:
    text = (
        Path("rig/benches/twin.toml")
        .read_text()
        .replace("[devices.torque_sensor]\n", "")
        .replace('type = "twin.torque_sensor"\n', "")
    )
    (tmp_path / "bench.toml").write_text(text)
    with pytest.raises(NotReady, match="no torque sensor, which has to show the weight"):
        campaign(LOADED, bench=read(str(tmp_path / "bench.toml")))


def test_an_endless_step_is_refused() -> None:
    with pytest.raises(UsageError, match="endless"):
        campaign('\n[[step]]\nprocedure = "standstill"\nwith = { duration = 1e9 }\n')


def test_the_dry_run_lists_every_run_and_change_in_order_with_a_total() -> None:
    found = campaign(REST, LOADED, LOCKED)
    told = "\n".join(lines(found))
    order = ["standstill", "hang 2 N·m", "+2 N·m", "take the weight off", "fit the lock pin", "lock-check, locked"]
    places = [told.index(word) for word in order]
    assert places == sorted(places)
    assert "3 runs, 4 changes by hand, 7 checks" in told
    assert "SIMULATED" in told


def test_the_stored_energy_is_that_of_motion_and_of_the_wound_up_gear() -> None:
    found = campaign(LOCK_TEST % 10.0, turning(300))
    locked, spinning = (figures(found, item) for item in found.items)
    assert locked.energy == pytest.approx(0.5 * locked.shaft_torque**2 / 7160, rel=0.01)
    assert spinning.energy == pytest.approx(0.5 * (1.1e-3 + 0.32 / 2500) * spinning.speed**2, rel=0.01)
    assert np.isclose(spinning.speed, 1.15 * 300 * math.pi / 30)


def test_a_dry_run_on_the_command_line_writes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan = tmp_path / "small.toml"
    plan.write_text(HEAD + REST)
    assert main(["campaign", str(plan), "--dry-run", "--out", str(tmp_path / "runs")]) == 0
    assert "1 runs" in capsys.readouterr().out
    assert list(tmp_path.iterdir()) == [plan]
