"""Whether the motor's encoder kept its zero since a slow run, from a lock test, which winds up over degrees of it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from rig.analysis.across_runs.wound_up import shown_by_windup
from rig.core.units import DEG
from rig.model.fourier import FourierSeries
from tests.analysis.synthetic import PROFILE, MadeRun, count

N, K = 50.0, 7000.0
RATE = 250.0
Array = np.ndarray


def straight(tau: Array) -> Array:
    return tau / K


def lock(
    moved_deg: float = 0.0,
    windup: Callable[[Array], Array] = straight,
    top: float = 60.0,
    gap: float = 0.0,
    series: FourierSeries = PROFILE,
    sensor: bool = True,
) -> MadeRun:
    """Two cycles to ±`top` N·m, the output held; the motor's zero `moved_deg` on, a `gap` rad between both ways."""
    rng = np.random.default_rng(3)
    t = np.arange(int(80.0 * RATE)) / RATE
    tau = top * np.interp(t % 40.0, [0.0, 10.0, 30.0, 40.0], [0.0, 1.0, -1.0, 0.0])
    wound = windup(tau) + 0.5 * gap * np.sign(np.gradient(tau))
    theta = N * wound
    for _ in range(30):  # θ_m/N = wind-up + θ̃_p(θ_m)
        theta = N * (wound + series.value(theta))
    columns = {
        "t": t,
        "theta_m": count(theta + moved_deg * DEG, 65_536),
        "theta_l": count(np.zeros(t.size), 1_296_000),
        "tau_l": tau + 0.05 * rng.standard_normal(t.size) if sensor else np.full(t.size, np.nan),
    }
    return MadeRun(columns, {"procedure": "stiffness_lock", "gear": {"ratio": N}})


@pytest.mark.parametrize("top", [40.0, 60.0])
def test_a_zero_that_was_kept_is_shown(top: float) -> None:
    assert shown_by_windup(lock(top=top), PROFILE)


def test_a_motor_that_turns_too_little_for_its_error_to_bend_shows_nothing() -> None:
    assert not shown_by_windup(lock(top=10.0), PROFILE)


def test_a_gap_between_both_ways_hides_it_no_more_than_noise_does() -> None:
    assert shown_by_windup(lock(gap=2e-5), PROFILE)


@pytest.mark.parametrize("moved", [12.0, -30.0, 90.0, 180.0, 270.0])
def test_a_zero_that_has_moved_is_not_shown(moved: float) -> None:
    assert not shown_by_windup(lock(moved), PROFILE)


def test_a_spring_that_is_far_from_straight_shows_nothing() -> None:
    assert not shown_by_windup(lock(windup=lambda tau: 8e-3 * np.tanh(tau / 15.0)), PROFILE)


def test_a_gear_without_an_error_shows_nothing() -> None:
    silent = FourierSeries((0.0,) * 15, (0.0,) * 15)
    assert not shown_by_windup(lock(series=silent), silent)
    assert not shown_by_windup(lock(series=silent), PROFILE)


def test_a_test_without_torque_shows_nothing() -> None:
    assert not shown_by_windup(lock(sensor=False), PROFILE)
