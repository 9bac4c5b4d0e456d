"""The low-pass and its derivatives do to readings and columns the same, and to polynomials nothing."""

import numpy as np
import pytest

from rig.analysis.tracing.runs.smoothing import Smoother, flat, flat_rate, kernel, thin


@pytest.mark.parametrize("derivative", [0, 1, 2, 3])
def test_a_power_of_time_has_its_exact_derivative(derivative: int) -> None:
    smooth = Smoother(36.0, 0.004, 2)
    t = np.arange(200) * 0.004
    y = smooth(t**derivative, derivative)
    assert y == pytest.approx(np.full(y.size, float(np.prod(np.arange(1, derivative + 1)))), rel=1e-6)


def test_rows_of_the_output_lie_where_centres_says() -> None:
    smooth = Smoother(36.0, 0.004, 2)
    t = np.arange(200) * 0.004
    assert smooth(t) == pytest.approx(t[smooth.centres(t.size)])


def test_a_wave_keeps_its_phase_and_loses_what_the_gaussian_says() -> None:
    smooth, hz = Smoother(36.0, 0.004, 1), 20.0
    t = np.arange(2000) * 0.004
    y = smooth(np.cos(2 * np.pi * hz * t))
    expected = np.exp(-0.5 * (hz / 36.0) ** 2) * np.cos(2 * np.pi * hz * t[smooth.centres(t.size)])
    assert np.max(np.abs(y - expected)) < 2e-3


def test_thinning_passes_slow_waves_and_stops_aliases() -> None:
    t = np.arange(8000) / 1000
    slow, first = thin(np.cos(2 * np.pi * 40 * t), 4)
    assert np.max(np.abs(slow - np.cos(2 * np.pi * 40 * t[first::4][: slow.size]))) < 2e-3
    alias, _ = thin(np.cos(2 * np.pi * 230 * t), 4)
    assert np.max(np.abs(alias)) < 2e-3


def test_rates_for_effects_are_flat_to_a_fifth_of_the_sample_rate() -> None:
    dt, hz = 0.004, 30.0
    t = np.arange(3000) * dt
    x, inside = np.sin(2 * np.pi * hz * t), slice(50, -50)
    assert np.max(np.abs(flat(x) - x)[inside]) < 5e-3
    speed = flat_rate(x, dt, 1)
    assert np.max(np.abs(speed - 2 * np.pi * hz * np.cos(2 * np.pi * hz * t))[inside]) < 0.01 * 2 * np.pi * hz


def test_kernels_of_odd_derivatives_do_not_see_a_constant() -> None:
    assert abs(kernel(0.0044, 0.004, 1).sum()) < 1e-9
    assert abs(kernel(0.0044, 0.004, 2).sum()) < 1e-6
