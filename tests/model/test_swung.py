"""A second mode in a run that was cut out of a longer motion, and what shakes it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rig.model.effect import Signals
from rig.model.memory import resonance
from rig.model.second_mode.shaken import NEAR, shaken
from rig.model.second_mode.swung import swung
from tests.contract.test_effects import motion

OMEGA, ZETA = 2 * np.pi * 11.8, 0.02  # forgets within 0.7 s
DT = 1e-3


def turning(speed: float, n: int = 9000) -> Signals:
    """A motor at `speed` rad/s."""
    t = DT * np.arange(n)
    return dataclasses.replace(motion(n=n), t=t, theta_m=speed * t + 0.7, omega_m=np.full(n, speed))


@pytest.mark.parametrize("speed", [20.0, 42.0, -42.0])
def test_a_run_cut_out_of_steady_motion_begins_in_full_swing(speed: float) -> None:
    s = turning(speed)
    wave = {2: 60.0 * np.exp(0.3j), 4: -15.0j}
    turned = {k: a * np.exp(1j * k * s.theta_m) for k, a in wave.items()}
    x = sum(w.real for w in turned.values()) + 3.0
    rate = {k: 1j * k * speed for k in wave}
    passed = {k: turned[k] * OMEGA**2 / (rate[k] ** 2 + 2 * ZETA * OMEGA * rate[k] + OMEGA**2) for k in wave}
    want = sum(w.real for w in passed.values()) + 3.0
    want_second = sum((rate[k] ** 2 * w).real for k, w in passed.items())
    got, got_second = swung(s, x, OMEGA, ZETA)
    at_rest, _ = resonance(x, DT, OMEGA, ZETA)
    np.testing.assert_allclose(got[1:], want[1:], atol=1e-3 * np.abs(want).max())
    np.testing.assert_allclose(got_second[1:], want_second[1:], atol=2e-3 * np.abs(want_second).max())
    assert np.abs(at_rest - want).max() > 0.3 * np.abs(want).max()


def test_waves_between_coarse_rows_come_out_at_full_height() -> None:
    """At 13 Hz in rows of 4 ms a line from row to row lacks 0.9 % of them."""
    dt = 4e-3
    t = dt * np.arange(4000)
    s = dataclasses.replace(motion(n=t.size), t=t, dt=dt, theta_m=41.0 * t, omega_m=np.full(t.size, 41.0))
    x = np.cos(2 * s.theta_m)
    gain = OMEGA**2 / ((82j) ** 2 + 2 * ZETA * OMEGA * 82j + OMEGA**2)
    got = swung(s, x, OMEGA, ZETA)[0][-500:]
    assert np.std(got) * np.sqrt(2) == pytest.approx(abs(gain), rel=2e-3)
    assert np.std(resonance(x, dt, OMEGA, ZETA)[0][-500:]) * np.sqrt(2) < 0.994 * abs(gain)


def test_a_motor_that_sets_out_from_rest_begins_with_the_mode_at_rest() -> None:
    s = turning(20.0)
    speed = np.clip(40.0 * s.t, 0.0, 20.0)
    s = dataclasses.replace(s, omega_m=speed, theta_m=np.cumsum(speed) * DT)
    x = 30.0 * np.cos(2 * s.theta_m)
    np.testing.assert_allclose(swung(s, x, OMEGA, ZETA)[0], resonance(x, DT, OMEGA, ZETA)[0], atol=1.0)
    assert swung(s, x, OMEGA, ZETA)[0][0] == x[0]
    still = dataclasses.replace(s, omega_m=np.zeros(s.t.size), theta_m=np.zeros(s.t.size))
    assert swung(still, x, OMEGA, ZETA)[0][0] == x[0]


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
