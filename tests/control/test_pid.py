"""The position loop's law: limits hold for any input, nothing winds up, nothing kicks."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.control.filter import SpeedFilter
from rig.control.pid import Pid
from rig.control.placement import place_poles
from rig.core.gains import Gains

GAINS = Gains(Kp=3.0, Ki=30.0, Kd=0.12, integrator_limit=1.5, torque_limit=5.0, feedforward=0.0033)
ANGLE = st.floats(-1e3, 1e3)
SPEED = st.floats(-1e3, 1e3)


@given(st.lists(st.tuples(ANGLE, SPEED, ANGLE, SPEED), min_size=1, max_size=50))
def test_torque_and_integral_never_exceed_their_limits(inputs: list[tuple[float, float, float, float]]) -> None:
    pid = Pid(GAINS, 0.001)
    for theta_ref, omega_ref, theta, omega in inputs:
        assert abs(pid.step(theta_ref, omega_ref, theta, omega)) <= GAINS.torque_limit
        assert abs(pid.integral) <= GAINS.integrator_limit


@given(ANGLE, SPEED)
def test_the_first_tick_on_the_measured_position_is_bumpless(theta: float, omega: float) -> None:
    assert Pid(GAINS, 0.001).step(theta, 0.0, theta, 0.0) == 0.0


@pytest.mark.slow
@given(st.lists(st.tuples(ANGLE, SPEED, ANGLE, SPEED), min_size=1, max_size=30))
def test_mirrored_inputs_give_mirrored_torque(inputs: list[tuple[float, float, float, float]]) -> None:
    one, other = Pid(GAINS, 0.001), Pid(GAINS, 0.001)
    for step in inputs:
        assert one.step(*step) == -other.step(*(-x for x in step))


def test_the_integral_is_held_while_the_torque_limit_is_reached() -> None:
    pid = Pid(GAINS, 0.001)
    for _ in range(10_000):
        pid.step(100.0, 0.0, 0.0, 0.0)
    assert pid.integral == 0.0
    assert pid.step(0.0, 0.0, 0.0, 0.0) == 0.0


def test_a_step_of_the_reference_kicks_only_through_the_proportional_part() -> None:
    assert math.isclose(Pid(GAINS, 0.001).step(0.1, 0.0, 0.0, 0.0), 0.1 * (GAINS.Kp + GAINS.Ki * 0.001))


def test_a_constant_disturbance_is_taken_over_by_the_integral() -> None:
    """A plain inertia with 0.3 N·m of constant drag follows a ramp without lasting error."""
    pid, theta, omega, dt = Pid(GAINS, 0.001), 0.0, 0.0, 0.001
    for k in range(5000):
        tau = pid.step(1.0 * k * dt, 1.0, theta, omega)
        omega += (tau - 0.3) / 1.2e-3 * dt
        theta += omega * dt
    assert abs(theta - 5.0) < 2e-3
    assert abs(pid.integral - 0.3 + GAINS.feedforward) < 0.02


def test_placed_poles_lie_where_they_were_asked() -> None:
    import numpy as np

    g = place_poles(inertia=1.2e-3, bandwidth=120.0, torque_limit=5.0, friction=0.3, viscous=0.0)
    roots = np.roots([1.2e-3, g.Kd, g.Kp, g.Ki])
    assert np.allclose(np.sort(roots), [-120.0, -15.0, -5.0], rtol=1e-9)


@pytest.mark.slow
@given(st.floats(-100.0, 100.0), st.floats(1e-4, 0.1))
def test_the_speed_filter_settles_on_the_true_speed(speed: float, time_constant: float) -> None:
    f = SpeedFilter(time_constant)
    for k in range(2000):
        f.step(k * 1e-3, speed * k * 1e-3)
    assert math.isclose(f.omega, speed, rel_tol=1e-6, abs_tol=1e-6)


@given(st.integers(1, 50))
def test_skipped_ticks_do_not_spike_the_speed(gap: int) -> None:
    f = SpeedFilter(0.008)
    for k in [*range(500), 500 + gap]:
        f.step(k * 1e-3, 2.0 * k * 1e-3)
    assert math.isclose(f.omega, 2.0, rel_tol=1e-6)


def test_a_repeated_time_stamp_is_no_news() -> None:
    f = SpeedFilter(0.008)
    for k in range(500):
        f.step(k * 1e-3, 2.0 * k * 1e-3)
    before = f.omega
    assert f.step(0.499, 1e9) == before
