"""What a lock test says, refuses to say, and is judged by."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.findings.result import Verdict
from rig.analysis.stiffness.path import Path
from tests.analysis.stiffness.plant import K, LockedGear
from tests.analysis.stiffness.test_spring import figures
from tests.analysis.synthetic import MadeRun, count, triangle


def test_a_lock_test_without_torque_says_so() -> None:
    t = np.arange(0, 40, 0.004)
    run = MadeRun(
        {"t": t, "theta_m": triangle(t, 0.35, 1 / 40)}, {"procedure": "stiffness_lock", "gear": {"ratio": 50}}
    )
    result = analyse(run)
    assert "without shaft torque" in result.sentence
    assert result.estimates == ()


def test_one_ramp_is_not_ramps_and_prose_has_true_minus_signs() -> None:
    t = np.arange(0, 20.0, 0.004)
    w = np.linspace(-0.007, 0.007, t.size)
    columns = {"t": t, "theta_m": count(50 * w, 65_536), "theta_l": np.zeros_like(t), "tau_l": 7160 * w}
    result = analyse(MadeRun(columns, {"procedure": "stiffness_lock", "gear": {"ratio": 50}}))
    figure = figures(result)["torsional_stiffness"]
    assert abs(figure.value / 7160 - 1) < 0.002
    assert "1 ramp, −4" in figure.how
    assert "1 ramps" not in figure.how
    assert any("no hysteresis loss" in s for s in result.cannot)


@pytest.mark.slow
def test_an_output_that_follows_fails_the_check_of_the_lock() -> None:
    run = LockedGear().run()
    free = {**run.columns, "theta_l": run.columns["theta_m"] / 50 * 0.2}
    check = next(c for c in analyse(MadeRun(free, run.manifest)).checks if c.name == "output_locked")
    assert not check.passed
    assert "25" in check.sentence


@pytest.mark.slow
def test_what_lies_in_series_is_taken_off() -> None:
    result = analyse(LockedGear().run(manifest={"declared": {"K_sensor": 20_000.0, "K_fixture": 1e6}}))
    figure = figures(result)["torsional_stiffness_gear"]
    assert abs(figure.value / (1 / (1 / K - 1 / 2e4 - 1 / 1e6)) - 1) < 0.01
    assert "torque sensor 20000 N·m/rad and fixture 1e+06 N·m/rad" in figure.how
    assert not any("Gear alone" in s for s in result.cannot)


@pytest.mark.slow
def test_a_path_softer_than_what_was_measured_is_said_to_be() -> None:
    assert Path((("fixture", 5000.0),)).gear(7160.0) == float("inf")
    result = analyse(LockedGear().run(manifest={"declared": {"K_fixture": 5000.0}}))
    assert any("softer than" in s for s in result.cannot)


@pytest.mark.slow
@pytest.mark.long
def test_a_limit_inside_the_interval_settles_nothing_and_one_outside_does() -> None:
    def verdict(lower: float) -> Verdict:
        manifest = {"limits": {"torsional_stiffness": {"lower": lower}}}
        return analyse(LockedGear().run(manifest=manifest)).verdict

    assert verdict(5000.0) is Verdict.PASS
    assert verdict(7100.0) is Verdict.INCONCLUSIVE
    assert verdict(9000.0) is Verdict.FAIL


@pytest.mark.slow
def test_lost_motion_is_the_wind_up_between_four_per_cent_of_rated_torque_either_way() -> None:
    figure = figures(analyse(LockedGear().run(manifest={"declared": {"T_rated": 100.0}})))["lost_motion"]
    assert abs(figure.value / (2 * 4.0 / K * 180 * 60 / np.pi) - 1) < 0.01
    small = analyse(LockedGear(reach=3.0 / K).run())
    assert any("Lost motion" in s for s in small.cannot)


@pytest.mark.slow
def test_a_run_without_time_still_has_its_spring() -> None:
    run = LockedGear().run()
    columns = {k: v for k, v in run.columns.items() if k != "t"}
    result = analyse(MadeRun(columns, run.manifest))
    assert abs(figures(result)["stiffness_K2"].value / K - 1) < 0.01
    assert any(s.startswith("Creep") for s in result.cannot)


@pytest.mark.slow
def test_the_figures_have_their_curves() -> None:
    curves = analyse(LockedGear(slip=((500.0, 0.5),)).run()).curves
    assert {"lock.windup", "lock.fit_torque", "tangent.measured", "loop.half_width", "creep.time"} <= set(curves)
    assert np.ptp(curves["lock.departure"]) > 0.9, "the loop stands out once the lines are taken off"


@pytest.mark.parametrize(("scale", "apart"), [(1.0, False), (141.6, True), (1 / 141.6, True)], ids=str)
def test_a_torque_that_the_motor_cannot_have_driven_is_told_and_nothing_is_judged(scale: float, apart: bool) -> None:
    t = np.arange(0, 20.0, 0.004)
    w = np.linspace(-0.007, 0.007, t.size)
    torques = {"tau_l": scale * 7160 * w, "tau_m": 7160 * w / 50 + 0.2}
    columns = {"t": t, "theta_m": count(50 * w, 65_536), "theta_l": np.zeros_like(t), **torques}
    result = analyse(MadeRun(columns, {"procedure": "stiffness_lock", "gear": {"ratio": 50}}))
    assert result.sentence.startswith("One of the torques seems to be in another unit: τ_l goes over") == apart
    assert (result.verdict is Verdict.INCONCLUSIVE) == apart


def test_a_gear_that_is_wound_up_from_its_output_tells_nothing_of_a_motor_that_a_brake_holds() -> None:
    t = np.arange(0, 20.0, 0.004)
    w = np.linspace(-0.007, 0.007, t.size)
    held = {"theta_m": np.zeros_like(t), "theta_l": -w, "tau_l": 7160 * w, "tau_m": 1e-3 * np.sin(t)}
    result = analyse(MadeRun({"t": t, **held}, {"procedure": "stiffness_lock", "gear": {"ratio": 50}}))
    assert "another unit" not in result.sentence


def test_a_wind_up_that_is_no_gears_is_told_and_nothing_is_judged() -> None:
    t = np.arange(0, 20.0, 0.004)
    w = np.linspace(-0.007, 0.007, t.size) * 180 / np.pi
    columns = {"t": t, "theta_m": 50 * w, "theta_l": np.zeros_like(t), "tau_l": 7160 * np.pi / 180 * w}
    result = analyse(MadeRun(columns, {"procedure": "stiffness_lock", "gear": {"ratio": 50}}))
    assert "the gear would be wound up by 46° from end to end, expected less than 3°" in result.sentence
    assert result.verdict is Verdict.INCONCLUSIVE
