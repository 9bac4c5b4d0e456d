"""A friction run on the twin: Coulomb and viscous friction of both sides, breakaway, and what is said of gaps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.findings.result import Verdict
from rig.analysis.identify.friction import motor_friction
from rig.analysis.identify.means import Mean, Torque
from rig.bench import read, twin_parameters
from rig.core.errors import UsageError
from rig.procedures.friction import Friction
from tests.studies.campaign import MemoryRun, take

RPM = np.pi / 30


@pytest.fixture(scope="module")
def run() -> MemoryRun:
    (found,), _, failed = take(read("twin"), [Friction(speeds_rpm="20,60,150,300,450", seconds=2.0, breakaways=2)])
    assert not failed
    return found


def figures(run: MemoryRun) -> dict[str, tuple[float, tuple[float, float]]]:
    return {e.name: (e.value, e.ci95) for e in analyse(run).estimates}


@pytest.mark.slow
def test_both_sides_friction_is_found_within_its_interval(run: MemoryRun) -> None:
    gear = twin_parameters(read("twin").file).gear
    found = figures(run)
    drag = gear.B_m + gear.B_ml * (1 + 1 / gear.ratio) ** 2
    for name, true, within in (
        ("motor_coulomb", gear.tau_c, 0.01), ("motor_viscous", drag, 0.04),
        ("load_coulomb", gear.F_cl, 0.01), ("load_viscous", gear.B_l, 0.04), ("sensor_zero", 0.04, 0.15),
        ("coulomb", gear.tau_c + gear.F_cl / gear.ratio, 0.01), ("viscous", drag + gear.B_l / gear.ratio**2, 0.04),
    ):  # fmt: skip
        value, (low, high) = found[name]
        assert value == pytest.approx(true, rel=within), name
        assert low - (high - low) / 2 < true < high + (high - low) / 2, name
    assert found["breakaway"][0] == pytest.approx(gear.tau_s, rel=0.05)
    assert abs(found["friction_drift"][0]) < 2.0


@pytest.mark.slow
def test_without_a_torque_sensor_the_whole_friction_is_still_seen_at_the_motor(run: MemoryRun) -> None:
    blind = replace(run, columns={k: v for k, v in run.columns.items() if k != "tau_l"})
    found = figures(blind)
    assert found["coulomb"][0] == pytest.approx(0.32, rel=0.01)
    assert "load_coulomb" not in found
    assert any("without a torque sensor" in s for s in analyse(blind).cannot)


@pytest.mark.slow
def test_friction_that_falls_while_the_run_goes_on_is_a_drift(run: MemoryRun) -> None:
    t = run.columns["t"]
    warm = {**run.columns, "tau_m": run.columns["tau_m"] * (1.0 - 0.3 * t / t[-1])}
    result = analyse(replace(run, columns=warm))
    drift = next(e for e in result.estimates if e.name == "friction_drift")
    assert drift.value < -5.0
    assert not next(c for c in result.checks if c.name == "warm").passed


@pytest.mark.slow
def test_angles_of_another_gear_give_no_friction_and_torques_of_none_settle_nothing(run: MemoryRun) -> None:
    degrees = analyse(replace(run, columns={**run.columns, "theta_m": np.degrees(run.columns["theta_m"])}))
    assert degrees.estimates == ()
    assert "θ_m seems to be in degrees" in degrees.sentence
    shown = analyse(replace(run, columns={**run.columns, "tau_m": 1e3 * run.columns["tau_m"]}))
    assert shown.verdict is Verdict.INCONCLUSIVE
    assert any("The unit of tau_m may be another one" in s for s in shown.cannot)


def test_a_run_at_one_speed_settles_nothing_and_says_so() -> None:
    t = np.arange(0.0, 8.0, 1e-3)
    columns = {"t": t, "theta_m": 30 * t, "theta_l": 0.6 * t, "tau_m": 0.3 + 0 * t, "tau_l": 1.0 + 0 * t}
    manifest = {
        "procedure": "friction", "gear": {"ratio": 50.0}, "conditions": {}, "declared": {}, "status": "completed",
    }  # fmt: skip
    result = analyse(MemoryRun("one", manifest, columns))
    assert "expected at least 4" in result.sentence
    assert result.verdict == "INCONCLUSIVE"


def rubbed(speeds: list[float], fall: float, omega_s: float) -> list[Mean]:
    """Plateaus of τ = (0.3 + fall·exp(−(ω/ω_s)²))·sgn ω + 0.003·ω with 1 mN·m of noise."""
    generator, out = np.random.default_rng(4), []
    for rpm in speeds:
        for omega in (rpm * RPM, -rpm * RPM):
            tau = (0.3 + fall * np.exp(-((omega / omega_s) ** 2))) * np.sign(omega) + 0.003 * omega
            noise = 1e-3 * generator.standard_normal()
            motor, none = Torque(tau + noise, 3e-3 * generator.standard_normal(10)), Torque(0.0, np.zeros(10))
            out.append(Mean("r", omega, 10.0, motor, none, motor, 0.0, 0.0))
    return out


@pytest.mark.slow
def test_a_fall_of_friction_at_slow_speeds_is_found_with_its_speed() -> None:
    found = motor_friction(rubbed([5, 10, 15, 20, 30, 60, 120, 240, 480], 0.1, 1.4))
    assert found is not None
    assert found.fall is not None
    assert found.omega_s == pytest.approx(1.4, rel=0.2)
    assert found.solved.coefficients[found.fall] == pytest.approx(0.1, rel=0.1)
    assert found.solved.coefficients[found.tau_c] == pytest.approx(0.3, abs=0.005)


def test_one_slow_speed_off_the_line_is_told_and_leaves_the_line_alone() -> None:
    found = motor_friction(rubbed([9.6, 60, 120, 240, 480], 0.1, 1.4))
    assert found is not None
    assert found.fall is None
    assert "three slow speeds" in found.doubt
    assert found.solved.coefficients[found.tau_c] == pytest.approx(0.3, abs=0.005)


def test_no_fall_is_invented_where_there_is_none() -> None:
    found = motor_friction(rubbed([5, 10, 20, 60, 120, 240, 480], 0.0, 1.0))
    assert found is not None
    assert found.fall is None
    assert found.doubt == ""


def test_speeds_that_do_not_rise_are_refused() -> None:
    with pytest.raises(UsageError, match=r"speeds_rpm = 5,5: expected at least two rising speeds"):
        Friction(speeds_rpm="5,5")


def test_each_speed_is_held_for_whole_turns_and_ten_degrees_of_output() -> None:
    p = Friction()
    for speed in p.speeds:
        turns = p.hold(speed * RPM, 50.0) * speed / 60
        assert turns == pytest.approx(round(turns), abs=1e-9)
        assert turns * 360 / 50 >= 10.0
        assert turns >= speed / 60 * p.seconds - 1e-9
