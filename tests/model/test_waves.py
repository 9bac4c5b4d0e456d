"""Compiled cosines, sines and sums are those of numpy and of Equation 8, to the last digit but one."""

from __future__ import annotations

import numpy as np
import pytest

from rig.model.fourier import FourierSeries
from rig.model.waves import BLOCK, FURTHEST, cosine_and_sine, left_of, powers, sums, wave

LAST = 2.3e-16  # the last digit of a double below 1
ANGLES = np.concatenate(
    [
        np.random.default_rng(0).uniform(-FURTHEST, FURTHEST, 100_000),
        np.arange(-40, 41) * np.pi / 4,  # where one quarter ends and the next begins
        [0.0, -0.0, 1e-300, np.nextafter(np.pi / 4, 1.0), 0.999999 * FURTHEST],
    ]
)


@pytest.mark.parametrize("angle", [ANGLES, ANGLES[:7], ANGLES[:0]])
def test_cosine_and_sine_are_those_of_numpy(angle: np.ndarray) -> None:
    cos, sin = cosine_and_sine(angle)
    assert np.max(np.abs(cos - np.cos(angle)), initial=0.0) < LAST
    assert np.max(np.abs(sin - np.sin(angle)), initial=0.0) < LAST


@pytest.mark.parametrize("far", [2.0 * FURTHEST, 1e300, np.nan])
def test_angles_too_large_or_unknown_are_left_to_numpy(far: float) -> None:
    angle = np.array([0.5, far])
    assert np.array_equal(cosine_and_sine(angle), (np.cos(angle), np.sin(angle)), equal_nan=True)


def test_waves_stand_side_by_side() -> None:
    assert np.allclose(wave(ANGLES), np.stack([np.cos(ANGLES), np.sin(ANGLES)], 1), atol=LAST)


def test_a_height_times_waves() -> None:
    height = np.linspace(-2.0, 3.0, ANGLES.size)
    assert np.array_equal(wave(ANGLES, height), wave(ANGLES) * height[:, None])


@pytest.mark.parametrize(
    ("hz", "left"), [(10.0, 1.0), (30.0, 1.0), (50.0, 0.5), (70.0, 0.0), (950.0, 0.5), (995.0, 1.0)]
)
def test_rows_have_lost_what_is_faster_and_readings_fold_over_what_is_faster_still(hz: float, left: float) -> None:
    omega = 2.0 * np.pi * np.array([hz, -hz, 1.0]) / 7.0
    np.testing.assert_allclose(left_of(7.0, omega, 0.01, 1000.0), [left, left, 1.0], atol=1e-12)


def test_powers_are_the_orders_and_their_slopes() -> None:
    theta = ANGLES[100_000:]
    each = [f(k * theta) for k in range(1, 16) for f in (np.cos, np.sin)]
    slopes = [x for k in range(1, 16) for x in (-k * np.sin(k * theta), k * np.cos(k * theta))]
    near = np.abs(theta) < 100.0  # k times an angle is rounded too
    assert np.allclose(powers(theta, 15)[near], np.stack(each, 1)[near], atol=1e-13)
    assert np.allclose(powers(theta, 15, slopes=True)[near], np.stack(slopes, 1)[near], atol=1e-12)


def test_sums_are_those_of_the_series_over_more_angles_than_a_block() -> None:
    series = FourierSeries((3e-4, -1e-4, 2e-5), (1e-4, 2e-4, -3e-5))
    theta = np.linspace(-300.0, 300.0, 2 * BLOCK + 7)
    value, slope, bend = sums(series, theta, 0, 1, 2)
    orders = np.multiply.outer(theta, series.orders)
    bent = -(np.cos(orders) @ (series.orders**2 * series.a) + np.sin(orders) @ (series.orders**2 * series.b))
    for made, said in ((value, series.value(theta)), (slope, series.slope(theta))):
        assert np.allclose(made, said, rtol=0.0, atol=1e-17)
    assert np.allclose(bend, bent, rtol=0.0, atol=1e-15)  # k times an angle of 300 rad is rounded too
    assert not np.any(sums(FourierSeries((), ()), theta, 0))
