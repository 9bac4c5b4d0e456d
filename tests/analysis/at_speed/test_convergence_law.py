"""The law of growth with speed: recovered from noisy waveforms, silent where nothing grows."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rig.analysis.at_speed.convergence import agreement, changes, chosen
from rig.analysis.at_speed.convergence_law import SpeedStep, deviation, fit_law, gains, speed_at
from tests.analysis.synthetic import ARCSEC, PROFILE, TURN, Array

RPM = np.pi / 30
PURE = (np.asarray(PROFILE.a) - 1j * np.asarray(PROFILE.b)) * ARCSEC
SPEEDS = (4.8, 9.6, 15.0, 20.0, 30.0, 40.0, 60.0)


def steps(hz: float, u: float, seed: int = 0, speeds: tuple[float, ...] = SPEEDS) -> list[SpeedStep]:
    rng = np.random.default_rng(seed)
    out = []
    for rpm in speeds:
        r2 = (np.arange(1.0, 16.0) * rpm * RPM / (TURN * hz)) ** 2
        z = PURE / (1.0 - r2 + 0.04j * np.sqrt(r2))
        noise = u * (rng.standard_normal(15) + 1j * rng.standard_normal(15))
        out.append(SpeedStep(rpm * RPM, z + noise, np.full(15, u), 13))
    return out


@pytest.mark.parametrize("hz", [pytest.param(12.0, marks=pytest.mark.slow), 25.0])
def test_the_frequency_lies_within_its_interval_at_least_nine_times_of_ten(hz: float) -> None:
    laws = [fit_law(steps(hz, 0.04, seed)) for seed in range(10)]
    assert all(law.resolved for law in laws)
    inside = [abs(law.omega_0 / (TURN * hz) - 1.0) <= 1.96 * law.u_relative + 0.01 for law in laws]
    assert sum(inside) >= 8


def test_a_stiff_gear_shows_no_growth_and_the_law_says_so() -> None:
    assert not fit_law(steps(400.0, 0.05)).resolved


def test_orders_beyond_their_resonance_do_not_spoil_the_fit() -> None:
    law = fit_law(steps(8.0, 0.03))  # at 60 rpm order 8 is at its resonance, orders 9 to 15 are above
    assert law.omega_0 / TURN == pytest.approx(8.0, rel=0.02)


@given(hz=st.floats(5.0, 100.0), tolerance=st.floats(0.001, 0.2))
@settings(max_examples=30)
def test_at_the_speed_for_a_tolerance_the_deviation_is_that_tolerance(hz: float, tolerance: float) -> None:
    omega = speed_at(PURE, TURN * hz, tolerance)
    assert deviation(PURE, omega, TURN * hz) == pytest.approx(tolerance, rel=1e-6)


def test_far_below_resonance_the_deviation_grows_with_the_square_of_the_speed() -> None:
    assert deviation(PURE, 0.2, 157.0) == pytest.approx(4.0 * deviation(PURE, 0.1, 157.0), rel=1e-3)
    assert gains(15, 200.0, 157.0)[0] == np.inf


def test_the_fastest_speed_that_agrees_falls_with_the_natural_frequency() -> None:
    def best(hz: float) -> float:
        made = steps(hz, 0.002)
        index = chosen(made, 0.005)
        return 0.0 if index is None else made[index].omega_m / RPM

    found: Array = np.array([best(hz) for hz in (8.0, 16.0, 32.0, 64.0)])
    assert (np.diff(found) > 0).all()


def test_a_waveform_that_changes_to_the_last_has_no_speed_that_agrees() -> None:
    made = steps(25.0, 0.001)
    for i, step in enumerate(made):
        step.phasor[1] *= 1.05**i
    assert chosen(made, 0.02) is None
    assert changes(made)[1][2] == pytest.approx(0.05, abs=0.002)


def test_a_speed_that_agrees_with_its_neighbour_is_not_called_slow_enough_where_the_law_says_otherwise() -> None:
    measured = steps(14.0, 0.03)
    best = chosen(measured, 0.02)
    assert best is not None
    law, omega = fit_law(measured), measured[best].omega_m
    assert omega > law.speed_at(0.02)  # 40 and 30 rpm differ by less than 2 %, and 40 rpm from standstill by more
    assert "though speed adds more than 2 % there" in agreement(omega, law, 0.02)
    assert "though" not in agreement(0.5 * law.speed_at(0.02), law, 0.02)
    stiff = fit_law(steps(400.0, 0.05))
    assert "though" not in agreement(omega, stiff, 0.02)  # nothing grows: there is no speed to hold against it
