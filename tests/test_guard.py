"""Each limit trips on its own, in words with numbers; a missing number trips too; a healthy sample never does."""

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from rig.core.channels import Flag
from rig.core.procedure import Envelope
from rig.core.sample import Sample, Torque
from rig.guard import RULES, Guard
from tests.fakes import LIMITS

ENVELOPE = Envelope(duration=10.0, travel=26.0, speed=1.0, torque=5.0)
GOOD = Sample(0.0, 1.0, 0.02, 1.0, 0.3, 1.0, 0.0, 0, 0, 0, "")
NAN = float("nan")


def guard() -> Guard:
    g = Guard(LIMITS, ENVELOPE, 50.0)
    assert g.check(GOOD, Torque(0.3)) is None
    return g


@pytest.mark.parametrize(
    ("name", "change", "asked", "number"),
    [
        ("drive", {"fault": "over-temperature of the motor"}, Torque(0.0), "over-temperature"),
        ("stale", {"age": 0.0061}, Torque(0.0), "6.1 ms"),
        ("speed", {"omega_m": 70.0}, Torque(0.0), "668 rpm"),
        ("speed", {"omega_m": -70.0}, Torque(0.0), "-668 rpm"),
        ("torque", {"tau_m": 5.6}, Torque(0.0), "5.60 N·m"),
        ("shaft_torque", {"tau_l": -46.0}, Torque(0.0), "-46.00 N·m"),
        ("travel", {"theta_m": 1.0 + 27.0, "theta_l": 0.02 + 27.0 / 50}, Torque(0.0), "1547.0°"),
        ("twist", {"theta_l": 0.03}, Torque(0.0), "0.573°"),
        ("following", {}, Torque(0.0, theta_ref=1.2), "11.5°"),
    ],
)
def test_each_limit_trips_with_its_number(name: str, change: dict[str, float], asked: Torque, number: str) -> None:
    trip = guard().check(GOOD._replace(**change), asked)  # type: ignore[arg-type]
    assert trip is not None
    assert trip.name == name
    assert number in trip.sentence


@pytest.mark.parametrize("channel", ["theta_m", "theta_l", "omega_m", "tau_m", "tau_l", "age"])
def test_a_missing_number_trips(channel: str) -> None:
    assert guard().check(GOOD._replace(**{channel: NAN}), Torque(0.0)) is not None


def test_a_torque_sensor_that_tells_no_number_is_not_said_to_be_at_the_end_of_its_range() -> None:
    trip = guard().check(GOOD._replace(tau_l=NAN, flags=int(Flag.SATURATED_TAU)), Torque(0.0))
    assert trip is not None
    assert "shaft torque is no number" in trip.sentence


def test_every_command_is_clipped_to_bench_and_procedure_and_nan_becomes_zero_and_trips() -> None:
    g = Guard(LIMITS, Envelope(10.0, 26.0, 1.0, torque=1.0), 50.0)
    g.check(GOOD, Torque(0.0))
    for asked, carried in ((0.5, 0.5), (-50.0, -1.0), (math.inf, 1.0), (NAN, 0.0)):
        assert g.allowed(Torque(asked, 1.0, 2.0)) == Torque(carried, 1.0, 2.0)
    for asked in (NAN, math.inf):
        trip = g.check(GOOD, Torque(asked))
        assert trip is not None
        assert trip.name == "asked"


def test_a_load_that_runs_away_trips_even_where_it_need_not_follow() -> None:
    free = Guard(LIMITS, Envelope(1.0, 6.0, 1.0, 5.0, coupled=False), 50.0)
    free.check(GOOD, Torque(0.0))
    trip = free.check(GOOD._replace(theta_l=0.02 + 2.2 * free.travel / 50), Torque(0.0))
    assert trip is not None
    assert "does the motor encoder count" in trip.sentence


def test_no_reference_means_nothing_to_follow() -> None:
    assert guard().check(GOOD, Torque(0.0, theta_ref=NAN)) is None


def test_the_allowed_following_error_grows_with_the_reference_speed() -> None:
    late = Torque(0.0, theta_ref=1.0 + 0.3, omega_ref=0.0)
    assert guard().check(GOOD, late) is not None
    assert guard().check(GOOD, late._replace(omega_ref=2.0)) is None


def test_an_uncoupled_procedure_may_find_a_load_that_does_not_follow() -> None:
    free = Guard(LIMITS, Envelope(1.0, 26.0, 1.0, 5.0, coupled=False), 50.0)
    free.check(GOOD, Torque(0.0))
    assert free.check(GOOD._replace(theta_l=0.5), Torque(0.0)) is None


def test_the_procedures_own_envelope_bounds_the_travel_more_tightly_than_the_bench() -> None:
    assert guard().travel < LIMITS.travel


@given(
    st.floats(-62, 62),
    st.floats(-5, 5),
    st.floats(-45, 45),
    st.floats(-25, 25),
    st.floats(0, 0.005),
    st.floats(-0.008, 0.008),
)
def test_inside_all_limits_nothing_trips(
    omega: float, tau_m: float, tau_l: float, moved: float, age: float, twist: float
) -> None:
    sample = GOOD._replace(
        omega_m=omega, tau_m=tau_m, tau_l=tau_l, age=age, theta_m=1.0 + moved, theta_l=0.02 + moved / 50.0 - twist
    )
    assert guard().check(sample, Torque(0.0)) is None


@given(st.lists(st.floats(allow_nan=True, allow_infinity=True), min_size=6, max_size=6))
@example([0.0, 0.0, 1.0, 0.0, 0.0, -1.0])  # stamped a second ahead of the clock
def test_the_quick_test_and_the_rules_always_agree(values: list[float]) -> None:
    g = guard()
    theta_m, theta_l, omega, tau_m, tau_l, age = values
    sample = Sample(0.0, theta_m, theta_l, omega, tau_m, tau_l, age, 0, 0, 0, "")
    trip, rules = g.check(sample, Torque(0.0)), [r(g, sample, Torque(0.0)) for r in RULES]
    assert (trip is None) == all(r is None for r in rules)
    if trip is not None:
        assert math.isfinite(len(trip.sentence))


@pytest.mark.parametrize(
    ("omega_ref", "word"), [(3.0, "45.8° behind its"), (-3.0, "45.8° ahead of its"), (0.0, "11.5° off its")]
)
def test_a_motor_is_ahead_of_its_reference_or_behind_it(omega_ref: float, word: str) -> None:
    trip = guard().check(GOOD, Torque(0.0, theta_ref=1.2 + 0.2 * abs(omega_ref), omega_ref=omega_ref))
    assert trip is not None
    assert word in trip.sentence
