"""States with memory, against closed forms and against scipy."""

import numpy as np
import pytest
from scipy import signal

from rig.model.memory import lagged, play, presliding, resonated


def test_play_follows_at_its_half_width_and_rests_when_the_input_turns_back():
    x = np.concatenate([np.linspace(0, 5, 51), np.linspace(5, 4, 11), np.linspace(4, -5, 91)])
    y = play(x, 1.0)
    assert y[50] == pytest.approx(4.0)
    assert y[61] == pytest.approx(4.0)
    assert y[-1] == pytest.approx(-4.0)


def test_play_loses_twice_its_width_times_the_way_in_a_cycle():
    x = 5.0 * np.sin(np.linspace(0.0, 4 * np.pi, 40_001))
    y = play(x, 1.0)
    second = slice(20_000, None)
    assert abs(np.trapezoid(y[second], x[second])) == pytest.approx(2 * 1.0 * 2 * (5.0 - 1.0), rel=1e-3)


def test_presliding_may_take_another_way_back():
    theta = np.concatenate([np.linspace(0, 1, 1000), np.linspace(1, 0, 1000)])
    z = presliding(theta, 0.05, 0.0, False, 3.0)
    np.testing.assert_allclose(z[:999], 1 - np.exp(-theta[:999] / 0.05), rtol=1e-12)
    np.testing.assert_allclose(z[1001:], -1 + 2 * np.exp(-(1 - theta[1001:]) / 0.15), atol=0.02)


def test_presliding_follows_its_exponential_and_saturates_at_one():
    theta = np.concatenate([np.linspace(0, 1, 101), np.linspace(1, 0.9, 11)])
    z = presliding(theta, 0.05)
    np.testing.assert_allclose(z[:101], 1 - np.exp(-theta[:101] / 0.05), atol=1e-12)
    assert z[-1] == pytest.approx(-1 + (z[100] + 1) * np.exp(-0.1 / 0.05))


def test_what_springs_back_does_so_in_a_straight_line_until_it_has_let_go():
    theta = np.concatenate([np.linspace(0, 1, 101), np.linspace(1, 0.8, 201)])
    z = presliding(theta, 0.05, 0.0, True)
    np.testing.assert_allclose(z[:101], 1 - np.exp(-theta[:101] / 0.05), atol=1e-12)
    back = 1.0 - theta[101:]
    springs = back < 0.05 * z[100]
    np.testing.assert_allclose(z[101:][springs], z[100] - back[springs] / 0.05, atol=1e-9)
    slid = back[~springs] - 0.05 * z[100]
    np.testing.assert_allclose(z[101:][~springs], np.exp(-slid / 0.05) - 1, atol=1e-9)


@pytest.mark.parametrize("lag", [0.4e-3, 3e-3, 0.2])
def test_a_lag_is_the_linear_system_it_says(lag: float):
    dt = 1e-3
    t = np.arange(2000) * dt
    x = 1.0 + np.sin(2 * np.pi * 17.3 * t) + 0.2 * t
    _, want, _ = signal.lsim(([1.0], [lag, 1.0]), x, t, X0=[x[0] * lag], interp=True)
    np.testing.assert_allclose(lagged(x, lag, dt), want, atol=1e-9)


def test_no_lag_changes_nothing():
    x = np.sin(np.arange(9.0))
    assert np.array_equal(lagged(x, 0.0, 1e-3), x)


@pytest.mark.parametrize(("frequency", "zeta"), [(5.0, 0.02), (40.0, 0.1), (300.0, 0.4)])
def test_a_resonator_is_the_linear_system_it_says(frequency: float, zeta: float):
    dt, omega = 1e-3, 2 * np.pi * frequency
    t = np.arange(3000) * dt
    x = np.sin(2 * np.pi * 7.3 * t) + 0.2 * t
    _, want, _ = signal.lsim(([omega**2], [1.0, 2 * zeta * omega, omega**2]), x, t, interp=True)
    np.testing.assert_allclose(resonated(x, dt, omega, zeta), want, atol=1e-9)
