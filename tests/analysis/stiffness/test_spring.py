"""K1, K2, K3, the cubic, which of them a run supports, and what the kinematic error does to them."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from rig.analysis import Result, analyse
from rig.analysis.stiffness.laws import lines
from rig.analysis.stiffness.tilt import unknown_tilt
from rig.model.fourier import FourierSeries
from tests.analysis.stiffness.plant import Array, K, LockedGear, three_lines
from tests.analysis.synthetic import PROFILE, slow_run

SLIP = ((700.0, 0.3), (500.0, 0.4), (3000.0, 0.2))  # 0.9 N·m in all, the last to slip does after 8e-4 rad


def figures(result: Result) -> dict[str, Any]:
    return {e.name: e for e in result.estimates}


def reach_at_15(spring: Any) -> float:
    u = np.linspace(0, 0.02, 20001)
    return float(np.interp(15.0, spring(u), u))


def cubic(u: Array) -> Array:
    return np.asarray(7160.0 * u + 6e8 * u**3)


def bent(**changes: Any) -> LockedGear:
    spring = three_lines(5000.0, 7160.0, 10_000.0, 5.0, 10.0)
    return LockedGear(spring=spring, reach=reach_at_15(spring), **changes)


@pytest.mark.slow
def test_one_line_is_found_to_do_and_every_stiffness_is_its_slope() -> None:
    result = analyse(LockedGear().run())
    found = figures(result)
    assert "one line describes it" in result.sentence
    for name in ("torsional_stiffness", "stiffness_K1", "stiffness_K2", "stiffness_K3", "cubic_k1"):
        assert abs(found[name].value / K - 1) < 0.005, name


@pytest.mark.slow
def test_three_lines_are_found_with_their_knots() -> None:
    result = analyse(bent().run())
    found = figures(result)
    assert "three lines with fitted knots" in result.sentence
    for name, true in (("stiffness_K1", 5000), ("stiffness_K2", 7160), ("stiffness_K3", 10_000)):
        assert abs(found[name].value / true - 1) < 0.02, name
    assert abs(found["knot_T1"].value - 5.0) < 0.15
    assert abs(found["knot_T2"].value - 10.0) < 0.15
    assert "Knots fitted" in found["stiffness_K1"].how


@pytest.mark.slow
def test_a_cubic_spring_is_named_with_its_coefficients_and_its_lines_are_those_of_the_cubic() -> None:
    reach = reach_at_15(cubic)
    result = analyse(LockedGear(spring=cubic, reach=reach).run())
    found = figures(result)
    assert "a cubic describes it better" in result.sentence
    assert abs(found["cubic_k1"].value / 7160 - 1) < 0.02
    assert abs(found["cubic_k3"].value / 6e8 - 1) < 0.03
    true = lines_through(cubic, reach)
    for i in range(3):
        assert abs(found[f"stiffness_K{i + 1}"].value / true[i] - 1) < 0.02


def lines_through(spring: Any, reach: float) -> Array:
    """The same three lines fitted to the noise-free spring."""
    from scipy.optimize import least_squares

    u = np.linspace(-reach, reach, 2001)
    tau = spring(u)
    secant = float(u @ tau) / float(u @ u)
    T = np.array([54.0, 196.0]) / 255.0 * secant * reach
    found = least_squares(lambda p: (lines(u, p * 1e4, T) - tau) / 15.0, [0.7, 0.7, 0.7])
    return np.asarray(found.x * 1e4)


@pytest.mark.slow
@pytest.mark.parametrize("gear", [bent(slip=SLIP), bent(slip=SLIP, drag=1500.0)])
def test_a_loop_does_not_change_what_the_spring_is_found_to_be(gear: LockedGear) -> None:
    found = figures(analyse(gear.run(seed=3)))
    for name, true in (("stiffness_K1", 5000), ("stiffness_K2", 7160), ("stiffness_K3", 10_000)):
        assert abs(found[name].value / true - 1) < 0.02, name


@pytest.mark.slow
def test_a_dead_zone_is_play_and_not_a_soft_spring() -> None:
    def spring(u: Array) -> Array:
        return np.asarray(K * np.sign(u) * np.maximum(np.abs(u) - 4e-5, 0.0))

    result = analyse(LockedGear(spring=spring).run())
    assert "a straight spring with play describes it better" in result.sentence
    assert abs(figures(result)["play"].value / (8e-5 * 180 * 60 / np.pi) - 1) < 0.05


@pytest.mark.slow
def test_declared_knots_are_used_and_said_to_be() -> None:
    result = analyse(LockedGear().run(manifest={"declared": {"T1": 4.0, "T2": 9.0}}))
    assert "Knots as declared" in figures(result)["stiffness_K2"].how
    assert figures(result)["stiffness_K2"].label == "Stiffness K2, 4 to 9 N·m"


@pytest.mark.slow
def test_without_a_slow_run_the_interval_is_as_wide_as_the_kinematic_error_may_tilt_it() -> None:
    result = analyse(LockedGear(error=PROFILE).run())
    figure = figures(result)["torsional_stiffness"]
    assert abs(figure.value / K - 1) > 0.02, "this gear's error tilts the curve by more than two per cent"
    assert figure.ci95[0] < K < figure.ci95[1]
    assert any("slow run" in s for s in result.cannot)


@pytest.mark.slow
def test_with_the_slow_run_of_the_campaign_the_tilt_is_taken_off() -> None:
    result = analyse(LockedGear(error=PROFILE).run(), slow_run(seed=5))
    figure = figures(result)["torsional_stiffness"]
    assert abs(figure.value / K - 1) < 0.003
    assert figure.ci95[0] < K < figure.ci95[1]
    assert (figure.ci95[1] - figure.ci95[0]) / K < 0.03
    assert not any("slow run" in s for s in result.cannot)


@pytest.mark.slow
def test_a_reference_of_another_motor_zero_is_not_used() -> None:
    other = FourierSeries(tuple(-a for a in PROFILE.a), tuple(-b for b in PROFILE.b))
    result = analyse(LockedGear(error=PROFILE, reach=60.0 / K).run(), slow_run(seed=5, profile=other))
    assert "does not fit this run" in figures(result)["torsional_stiffness"].how


@pytest.mark.slow
def test_how_much_of_the_error_the_loaded_gear_shows_is_fitted_where_the_motor_turns_far_enough() -> None:
    gear = LockedGear(error=PROFILE, error_share=0.6, reach=0.02)  # ±57° of the motor
    figure = figures(analyse(gear.run(), slow_run(seed=5)))["torsional_stiffness"]
    shown = re.search(r"shows ([\d.]+) ±", figure.how)
    assert shown is not None
    assert abs(float(shown[1]) - 0.6) < 0.01
    assert abs(figure.value / K - 1) < 0.002


def test_a_line_over_a_small_swing_can_mistake_the_whole_slope_of_the_error_and_over_a_wide_one_hardly_any() -> None:
    arcsec = np.pi / 180 / 3600
    assert abs(unknown_tilt(50.0, 0.0) - 50 * (2 * 90 + 4 * 22.5) * arcsec) < 1e-4
    assert unknown_tilt(50.0, np.pi) < 0.02
