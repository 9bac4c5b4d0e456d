"""A second mode in a run that was cut out of a longer motion, and what shakes it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rig.model.effect import Signals
from rig.model.memory import resonance
from rig.model.shaken import NEAR, shaken
from rig.model.swung import swung
from tests.contract.test_effects import motion

OMEGA, ZETA = 2 * np.pi * 11.8, 0.02  # forgets within 0.7 s
DT = 1e-3


def turning(speed: float, n: int = 9000) -> Signals:
    """A motor at `speed` rad/s."""
    t = DT * np.arange(n)
    return dataclasses.replace(motion(n=n), t=t, theta_m=speed * t + 0.7, omega_m=np.full(n, speed))


def later(s: Signals, x: np.ndarray, rows: int) -> tuple[Signals, np.ndarray]:
    """What is recorded of it from a row on."""
    return dataclasses.replace(s, t=s.t[rows:], theta_m=s.theta_m[rows:], omega_m=s.omega_m[rows:]), x[rows:]


@pytest.mark.parametrize("speed", [20.0, 42.0, -42.0])
def test_a_run_cut_out_of_steady_motion_begins_in_full_swing(speed: float) -> None:
    s = turning(speed)
    x = 60.0 * np.cos(2 * s.theta_m + 0.3) + 15.0 * np.sin(4 * s.theta_m) + 3.0
    whole, second = resonance(x, DT, OMEGA, ZETA)
    got, got_second = swung(*later(s, x, 5000), OMEGA, ZETA)
    at_rest, _ = resonance(x[5000:].copy(), DT, OMEGA, ZETA)
    np.testing.assert_allclose(got, whole[5000:], atol=1e-3 * np.abs(whole).max())
    np.testing.assert_allclose(got_second[1:], second[5001:], atol=2e-3 * np.abs(second).max())
    assert np.abs(at_rest - whole[5000:]).max() > 0.3 * np.abs(whole).max()


def test_a_motor_that_sets_out_from_rest_begins_with_the_mode_at_rest() -> None:
    s = turning(20.0)
    speed = np.clip(40.0 * s.t, 0.0, 20.0)
    s = dataclasses.replace(s, omega_m=speed, theta_m=np.cumsum(speed) * DT)
    x = 30.0 * np.cos(2 * s.theta_m)
    np.testing.assert_array_equal(swung(s, x, OMEGA, ZETA)[0], resonance(x, DT, OMEGA, ZETA)[0])
    still = dataclasses.replace(s, omega_m=np.zeros(s.t.size), theta_m=np.zeros(s.t.size))
    np.testing.assert_array_equal(swung(still, x, OMEGA, ZETA)[0], resonance(x, DT, OMEGA, ZETA)[0])


def test_a_slow_motor_shakes_a_mode_where_it_turns_back_and_nowhere_else() -> None:
    s = turning(1.0, n=12000)
    way = np.where((s.t > 4.0) & (s.t < 8.0), -1.0, 1.0)
    s = dataclasses.replace(s, omega_m=way)
    near = shaken(s, np.ones(s.t.size)) > 0
    apart = np.minimum(np.abs(s.t - 4.0), np.abs(s.t - 8.0))
    np.testing.assert_array_equal(near[np.abs(apart - NEAR) > 0.01], (apart < NEAR)[np.abs(apart - NEAR) > 0.01])
    assert not shaken(dataclasses.replace(s, omega_m=0.05 * way), np.ones(s.t.size)).any(), "a lock test"
    rested = dataclasses.replace(s, omega_m=np.where(np.abs(s.t - 4.0) < 0.5, 0.0, way))
    assert not shaken(rested, np.ones(s.t.size))[: round(6 / DT)].any(), "it rested between"
    assert shaken(turning(4.0), np.ones(9000)).all()
