"""What a steady motor makes again and again, without the noise between its orders."""

from __future__ import annotations

import dataclasses

import numpy as np

from rig.model.effect import Signals
from rig.model.second_mode.ordered import FAST, ordered, shaking
from tests.contract.test_effects import motion

DT = 2e-3


def turning(speed: float, swing: float = 0.0) -> Signals:
    """10 s of a motor at `speed` rad/s, faster and slower by `swing` of it."""
    t = np.arange(5000) * DT
    omega = speed * (1.0 + swing * np.sin(2 * np.pi * 0.3 * t))
    theta = np.concatenate([[0.0], np.cumsum(omega[:-1] * DT)])
    return dataclasses.replace(motion(n=t.size), t=t, dt=DT, theta_m=theta, omega_m=omega)


def test_orders_and_the_mean_stay_and_noise_between_them_goes(rng: np.random.Generator) -> None:
    s = turning(30.0)
    made = 0.3 + np.cos(6 * s.theta_m + 0.4) + 0.5 * np.sin(11 * s.theta_m)
    kept = ordered(s, made + rng.standard_normal(s.t.size))
    assert np.sqrt(np.mean((kept - made) ** 2)) < 0.3  # 31 numbers of 840 rows, a fifth of what noise there was
    np.testing.assert_allclose(ordered(s, made), made, atol=0.02)


def test_what_is_no_order_goes_and_a_motion_that_is_not_steady_is_left_alone(rng: np.random.Generator) -> None:
    s = turning(30.0)
    assert np.abs(ordered(s, np.cos(6.5 * s.theta_m))).max() < 0.1
    noise = rng.standard_normal(s.t.size)
    for other in (turning(30.0, swing=0.3), turning(1.0), turning(0.0)):
        assert ordered(other, noise) is noise


def test_of_a_slow_mode_all_counts_that_shakes_it() -> None:
    s = turning(30.0)
    x = np.cos(6.5 * s.theta_m)
    assert shaking(s, "x", x, 0.9 * FAST) is x
    assert shaking(s, "x", x, 1.1 * FAST) is not x
