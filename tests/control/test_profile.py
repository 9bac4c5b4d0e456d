"""References are continuous, stay within what they declare, and end where they say."""

import math

from hypothesis import given
from hypothesis import strategies as st

from rig.control.profile import Trapezoid, Triangle

AMPLITUDE = st.floats(0.01, 100.0)
FREQUENCY = st.floats(0.001, 10.0)


def test_the_slow_measurement_turns_the_motor_at_9_6_rpm_for_200_s() -> None:
    wave = Triangle(math.radians(1440.0), 0.01, 2.0)
    assert math.isclose(wave.speed * 30 / math.pi, 9.6)
    assert math.isclose(wave.duration, 200.0)
    assert wave.at(25.0)[0] == 0.0 or math.isclose(wave.at(25.0)[0], math.radians(1440.0))


@given(AMPLITUDE, FREQUENCY, st.integers(1, 5), st.floats(0.0, 1.0))
def test_a_triangle_stays_within_its_amplitude_at_its_slope(
    amplitude: float, frequency: float, cycles: int, share: float
) -> None:
    wave = Triangle(amplitude, frequency, cycles)
    offset, speed = wave.at(share * wave.duration)
    assert abs(offset) <= amplitude * (1 + 1e-12)
    assert abs(speed) in (0.0, wave.speed)


@given(AMPLITUDE, FREQUENCY, st.floats(0.0, 0.999))
def test_a_triangle_never_jumps(amplitude: float, frequency: float, share: float) -> None:
    wave = Triangle(amplitude, frequency, 1)
    t, dt = share * wave.duration, 1e-6 * wave.duration
    assert abs(wave.at(t + dt)[0] - wave.at(t)[0]) <= wave.speed * dt * (1 + 1e-6) + 1e-9 * amplitude


@given(AMPLITUDE, FREQUENCY, st.floats(0.01, 0.49))
def test_the_second_half_of_a_triangle_mirrors_the_first(amplitude: float, frequency: float, share: float) -> None:
    wave = Triangle(amplitude, frequency, 1)
    early, late = wave.at(share / frequency)[0], wave.at((1 - share) / frequency)[0]
    assert math.isclose(early, -late, abs_tol=1e-9 * amplitude)


def test_a_reference_is_at_rest_before_and_after() -> None:
    for wave in (Triangle(1.0, 0.5, 2), Trapezoid(1.0, 1.0, 2.0)):
        assert wave.at(-1.0) == (0.0, 0.0)
        assert wave.at(wave.duration + 1.0)[1] == 0.0


@given(st.floats(-50.0, 50.0), st.floats(0.1, 60.0), st.floats(0.1, 100.0), st.floats(0.0, 1.0))
def test_a_trapezoid_keeps_its_speed_and_arrives(distance: float, speed: float, accel: float, share: float) -> None:
    move = Trapezoid(distance, speed, accel)
    offset, omega = move.at(share * move.duration)
    assert abs(omega) <= speed * (1 + 1e-9)
    assert -1e-9 <= offset * math.copysign(1.0, distance) <= abs(distance) * (1 + 1e-9) + 1e-12
    assert move.at(move.duration + 1e-9)[0] == distance


@given(st.floats(0.5, 50.0), st.floats(0.1, 60.0), st.floats(0.1, 100.0), st.floats(0.01, 0.98))
def test_the_speed_of_a_trapezoid_is_the_slope_of_its_offset(
    d: float, speed: float, accel: float, share: float
) -> None:
    move = Trapezoid(d, speed, accel)
    t, h = share * move.duration, 1e-4 * move.duration
    slope = (move.at(t + h)[0] - move.at(t - h)[0]) / (2 * h)
    assert math.isclose(slope, move.at(t)[1], rel_tol=1e-3, abs_tol=accel * h * 2)
