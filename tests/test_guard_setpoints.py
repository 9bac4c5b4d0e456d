"""Speeds and angles are clipped like torques; readings of different age may differ by what was turned between them."""

import math

import pytest

from rig.core.channels import Flag
from rig.core.procedure import Envelope
from rig.core.sample import Position, Sample, Torque, Velocity
from rig.guard import Guard
from tests.fakes import LIMITS

GOOD = Sample(0.0, 1.0, 0.02, 1.0, 0.3, 1.0, 0.0, 0, 0, 0, "")
NAN = float("nan")


def guard() -> Guard:
    made = Guard(LIMITS, Envelope(duration=10.0, travel=26.0, speed=1.0, torque=5.0), 50.0)
    assert made.check(GOOD, Torque(0.0)) is None
    return made


@pytest.mark.parametrize(("asked", "carried"), [(3.0, 3.0), (100.0, 62.8), (-math.inf, -62.8), (NAN, 0.0)])
def test_a_speed_is_clipped_at_the_bench_s_limit(asked: float, carried: float) -> None:
    assert guard().allowed(Velocity(asked, 1.0, 2.0)) == Velocity(carried, 1.0, 2.0)


def test_an_angle_is_clipped_to_the_travel_from_where_the_run_starts() -> None:
    g = guard()
    assert g.allowed(Position(20.0, 20.0, 1.0)) == Position(20.0, 20.0, 1.0)
    assert g.allowed(Position(500.0)).theta == pytest.approx(1.0 + g.travel)
    assert math.isnan(g.allowed(Position(NAN)).theta)  # no new angle: the drive keeps the last


def test_no_angle_passes_before_it_is_known_where_the_run_starts() -> None:
    fresh = Guard(LIMITS, Envelope(duration=10.0, travel=26.0, speed=1.0, torque=5.0), 50.0)
    assert math.isnan(fresh.allowed(Position(1.0)).theta)


@pytest.mark.parametrize("asked", [Velocity(NAN), Position(NAN), Position(math.inf), Velocity(-math.inf)])
def test_what_is_no_number_trips_in_its_own_unit(asked: Velocity | Position) -> None:
    trip = guard().check(GOOD, asked)
    assert trip is not None
    assert ("rad/s" in trip.sentence) is isinstance(asked, Velocity)


def test_a_load_reading_that_is_late_may_lag_by_what_the_motor_turned_since_and_no_more() -> None:
    moving = GOOD._replace(theta_m=2.0, theta_l=0.029, omega_m=60.0, age=0.004)  # 0.63° apart, limit 0.5°
    late = moving._replace(flags=int(Flag.STALE_L))  # 60 rad/s · 4 ms / 50 = 0.28°
    assert guard().check(late, Torque(0.0)) is None
    assert guard().check(moving, Torque(0.0)) is None  # it came in the meantime, and is as old: after a stall
    of_the_torque = moving._replace(flags=int(Flag.STALE_TAU))  # both angles are new
    for wrong in (of_the_torque, late._replace(omega_m=5.0), late._replace(theta_l=0.02), late._replace(theta_l=NAN)):
        trip = guard().check(wrong, Torque(0.0))
        assert trip is not None
        assert trip.name == "twist" or math.isnan(wrong.theta_l)
