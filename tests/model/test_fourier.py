"""Equation 8: value, slope and size of the series agree with each other and with Parseval."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.model.fourier import BLOCK, FourierSeries

COEFFICIENTS = st.lists(st.floats(-1e-3, 1e-3), min_size=1, max_size=15)


@st.composite
def series(draw: st.DrawFn) -> FourierSeries:
    a = draw(COEFFICIENTS)
    b = draw(st.lists(st.floats(-1e-3, 1e-3), min_size=len(a), max_size=len(a)))
    return FourierSeries(tuple(a), tuple(b))


@given(series(), st.floats(-100.0, 100.0))
def test_the_slope_is_the_derivative_of_the_value(s: FourierSeries, theta: float) -> None:
    h = 1e-5
    difference = (s.value(np.array(theta + h)) - s.value(np.array(theta - h))) / (2 * h)
    assert float(s.slope(np.array(theta))) == pytest.approx(float(difference), abs=1e-7)


@pytest.mark.slow
@given(series(), st.floats(-10.0, 10.0), st.integers(-5, 5))
def test_it_repeats_every_motor_turn_and_has_no_mean(s: FourierSeries, theta: float, turns: int) -> None:
    moved = theta + 2 * math.pi * turns
    assert float(s.value(np.array(moved))) == pytest.approx(float(s.value(np.array(theta))), abs=1e-12)
    grid = np.linspace(0, 2 * math.pi, 64, endpoint=False)
    assert abs(float(np.mean(s.value(grid)))) < 1e-15


@given(series())
def test_its_mean_square_is_half_the_sum_of_squared_amplitudes(s: FourierSeries) -> None:
    grid = np.linspace(0, 2 * math.pi, 256, endpoint=False)
    assert float(np.mean(s.value(grid) ** 2)) == pytest.approx(0.5 * float(np.sum(s.amplitude**2)), abs=1e-15)


@given(series())
def test_polar_and_cartesian_forms_are_the_same_series(s: FourierSeries) -> None:
    again = FourierSeries.from_polar(s.amplitude, s.phase)
    grid = np.linspace(0, 2 * math.pi, 50)
    assert np.allclose(again.value(grid), s.value(grid), atol=1e-15)


def test_one_order_swings_by_twice_its_amplitude() -> None:
    assert FourierSeries((0.0, 3e-4), (0.0, 4e-4)).peak_to_peak() == pytest.approx(1e-3, rel=1e-3)


def test_unequal_lists_are_refused_with_their_lengths() -> None:
    with pytest.raises(ValueError, match="2 cosine and 1 sine"):
        FourierSeries((0.0, 1.0), (0.0,))


def test_the_sum_by_horner_is_the_sum_of_equation_8_over_more_angles_than_a_block() -> None:
    s = FourierSeries((3e-4, -1e-4, 2e-5), (1e-4, 2e-4, -3e-5))
    theta = np.linspace(-300.0, 300.0, 2 * BLOCK + 7)
    each = np.array(
        [[a * np.cos(n * theta), b * np.sin(n * theta)] for n, (a, b) in enumerate(zip(s.a, s.b, strict=True), 1)]
    )
    assert np.allclose(s.value(theta), each.sum((0, 1)), atol=1e-15)
    assert s.value(theta.reshape(-1, 1)).shape == (theta.size, 1)
    assert not np.any(FourierSeries((), ()).slope(theta))
