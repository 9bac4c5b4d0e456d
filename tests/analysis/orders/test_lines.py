"""Order spectra: amplitudes, non-integer orders, lines without false alarms."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rig.analysis.orders.lines import find_lines, fit_lines, resample, spectrum
from rig.core.units import TURN
from tests.analysis.synthetic import wander


def turning(turns: float, rows_per_turn: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.sort(rng.uniform(0, turns * TURN, int(turns * rows_per_turn)))


@settings(max_examples=30, deadline=None)
@given(order=st.floats(1.0, 12.0), amplitude=st.floats(0.5, 30.0), phase=st.floats(-3.0, 3.0), seed=st.integers(0, 50))
def test_an_order_of_any_value_has_its_amplitude_and_phase_within_its_uncertainty(
    order: float, amplitude: float, phase: float, seed: int
) -> None:
    theta = turning(40, 200, seed)
    y = amplitude * np.cos(order * theta - phase) + np.random.default_rng(seed).standard_normal(theta.size)
    (line,) = fit_lines(theta, y, [order])
    assert abs(line.amplitude - amplitude) < 5 * line.u
    assert abs((line.phase - phase + np.pi) % TURN - np.pi) < 5 * line.u_phase
    assert 0.005 < line.u < 0.03, "σ·√(2/n) is 0.016"


def test_two_and_two_point_zero_four_are_told_apart_over_a_full_output_turn() -> None:
    theta = turning(50, 300)
    y = (
        40 * np.cos(2 * theta - 1.0)
        + 12 * np.cos(2.04 * theta + 0.5)
        + np.random.default_rng(1).normal(0, 1, theta.size)
    )
    near = {round(line.order, 2): line for line in find_lines(theta, y, 40.0)}
    assert set(near) == {2.0, 2.04}
    assert abs(near[2.04].amplitude - 12) < 0.2
    assert abs(near[2.0].amplitude - 40) < 0.2


@pytest.mark.parametrize("red", [0.0, 0.02, 0.3])
def test_noise_alone_seldom_makes_a_line(red: float) -> None:
    """Asked for 1 run in 100; up to 4 in 100 are let pass here, 60 runs are looked at."""
    rng = np.random.default_rng(4)
    alarms = 0
    for _ in range(60):
        theta = np.arange(4000) * (TURN / 100)
        noise = rng.standard_normal(4000) if not red else wander(rng, 4000, 0.01, red, 1.0)
        alarms += bool(find_lines(theta, noise, 40.0, slowest=0.5, most=2))
    assert alarms <= 4


def test_a_weak_line_in_noise_is_found_and_known_orders_do_not_hide_it() -> None:
    theta = turning(60, 200)
    rng = np.random.default_rng(2)
    y = 90 * np.cos(2 * theta) + 20 * np.cos(4 * theta) + 0.5 * np.cos(12.37 * theta) + rng.normal(0, 2, theta.size)
    found = find_lines(theta, y, 80.0, known=(1, 2, 3, 4))
    assert [round(line.order, 2) for line in found] == [2.0, 4.0, 12.37]


def test_the_spectrum_shows_a_sine_at_its_amplitude_up_to_order_forty() -> None:
    theta = turning(30, 2000)
    for order in (2.0, 13.3, 38.0):
        orders, amplitude = spectrum(theta, 7.0 * np.cos(order * theta), 40.0)
        peak = int(np.argmax(amplitude))
        assert abs(orders[peak] - order) < 0.03
        assert abs(amplitude[peak] - 7.0) < 0.25


def test_the_spectrum_ends_where_the_rows_end() -> None:
    orders, _ = spectrum(turning(30, 20), np.zeros(600), 40.0)
    assert orders.max() <= 8.0


def test_resampling_keeps_every_row_and_fills_gaps() -> None:
    theta = np.concatenate((np.linspace(0, 3, 3000), np.linspace(3.5, TURN, 3000)))
    turns, values = resample(theta, theta, 64)
    assert np.allclose(values, turns * TURN, atol=0.05)


def test_a_bin_stands_for_its_centre_wherever_its_rows_lie() -> None:
    theta = np.linspace(0.0, 40.0 * TURN, 20_000)
    theta += 0.003 * np.sin(0.37 * np.arange(theta.size))  # a bin of the 320 holds one row or two, on either side
    grid, values = resample(theta, np.sin(7.0 * theta), 320)
    assert np.abs(values - np.sin(7.0 * TURN * grid))[1:-1].max() < 2e-3  # along a chord to one neighbour: 3e-3


@pytest.mark.parametrize(("per_turn", "bins", "first"), [(1000, 60, 137.59590236508745), (50, 6, -300.57337880034885)])
def test_the_row_that_rounding_puts_behind_the_last_bin_is_in_it(per_turn: int, bins: int, first: float) -> None:
    """Sixty bins are 59.999… by one product and 60 by another."""
    theta = first + bins * TURN / per_turn * np.linspace(0.0, 1.0, 4001)
    assert int((theta.max() / TURN - theta.min() / TURN) * per_turn) == bins - 1
    grid, values = resample(theta, np.ones_like(theta), per_turn)
    assert grid.size == values.size == bins - 1
    assert values == pytest.approx(1.0)
