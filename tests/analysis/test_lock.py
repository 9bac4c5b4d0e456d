"""Output locked: secant stiffness and loop width."""

from __future__ import annotations

from typing import Any

import numpy as np

from rig.analysis import Result, analyse
from tests.analysis.synthetic import MadeRun, count, triangle

ARCMIN = 60 * 180 / np.pi


def locked(half_width: float = 0.0, K: float = 7160.0, cycles: int = 3, seed: int = 0) -> Result:
    """Wind-up ±0.007 rad; torque K·w plus friction that flips over 2e-4 rad of travel, `half_width` N·m either way."""
    rng = np.random.default_rng(seed)
    t = np.arange(0, 40.0 * cycles, 0.004)
    w = triangle(t, 0.007, 1 / 40)
    h = np.empty_like(w)
    x = 0.0
    for i, step in enumerate(np.diff(w, prepend=0.0)):
        x = float(np.clip(x + step / 2e-4, -1.0, 1.0))
        h[i] = x
    tau = K * w + half_width * h + rng.normal(0, 0.05, t.size)
    columns = {"t": t, "theta_m": count(50 * w, 65_536), "theta_l": np.zeros_like(t), "tau_l": tau}
    about = {"procedure": "stiffness_lock", "gear": {"ratio": 50}, "conditions": {"output_locked": True}}
    return analyse(MadeRun(columns, about))


def figures(result: Result) -> dict[str, Any]:
    return {e.name: e for e in result.estimates}


def test_the_secant_is_the_stiffness_and_its_interval_allows_for_the_kinematic_error() -> None:
    figure = figures(locked())["torsional_stiffness"]
    assert abs(figure.value / 7160 - 1) < 0.003
    low, high = figure.ci95
    assert 0.06 < (high - low) / 2 / figure.value < 0.09


def test_the_loop_is_as_wide_as_the_friction_makes_it() -> None:
    figure = figures(locked(half_width=0.7))["loop_width"]
    expected = 2 * 0.7 / 7160 * ARCMIN
    assert abs(figure.value - expected) < 0.02
    assert figure.ci95[0] < figure.value < figure.ci95[1]


def test_an_elastic_gear_has_no_loop() -> None:
    assert abs(figures(locked())["loop_width"].value) < 0.01


def test_the_finer_analysis_is_said_to_come_later() -> None:
    assert any("K1, K2, K3" in s for s in locked().cannot)


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
    how = figures(result)["torsional_stiffness"].how
    assert "1 ramp, −50.1 to 50.1 N·m" in how
    assert "1 ramps" not in how
