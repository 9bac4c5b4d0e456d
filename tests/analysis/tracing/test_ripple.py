"""What one angle and one torque can say: laws of the ripple are given back, and none is made up."""

import numpy as np
import pytest

from rig.analysis.tracing.outcome.ripple import DAY, HIGHEST, Seen, _laws

RNG = np.random.default_rng(3)
SPEEDS = (6.0, 12.0, 20.0, 31.0, -20.0, -31.0)
NOISE = 1e-3


def seen(speed: float, load: float, start: float = 0.0, lag: float = 0.0, gain: float = 1.0) -> Seen:
    """Order 2 of 0.2 N·m, 10 mN·m more per N·m, 50 µN·m more per (rad/s)², read `lag` late; order 7 of 30 mN·m."""
    phasors = NOISE * (RNG.standard_normal(HIGHEST) + 1j * RNG.standard_normal(HIGHEST)) / np.sqrt(2)
    phasors[1] += gain * (0.2 + 0.01 * load + 5e-5 * speed**2) * np.exp(0.7j - 2j * speed * lag)
    phasors[6] += 0.03 * np.exp(-7j * speed * lag)
    return Seen(speed, load, start, phasors, NOISE)


def test_constant_load_and_speed_parts_and_the_lag_come_back():
    two, seven = _laws("tau_l", [seen(v, load, lag=4e-4) for v in SPEEDS for load in (0.5, 20.0)], True)
    assert (two.order, seven.order) == (2, 7)
    assert two.constant == pytest.approx(0.2, rel=0.02)
    assert two.per_load == pytest.approx(0.01, rel=0.02)
    assert two.per_speed_squared == pytest.approx(5e-5, rel=0.05)
    assert two.lag is not None
    assert two.lag[0] == pytest.approx(4e-4, abs=2 * two.lag[1])
    assert two.lag[1] < 5e-5


def test_one_speed_has_no_law_of_speed_and_no_lag():
    (two, _) = _laws("tau_l", [seen(12.0, load) for load in (0.5, 5.0, 20.0)], True)
    assert two.per_speed_squared is None
    assert two.lag is None
    assert two.per_load == pytest.approx(0.01, rel=0.05)


def test_without_time_nothing_is_said_of_speed():
    for r in _laws("tau_l", [seen(v, 1.0) for v in SPEEDS], False):
        assert r.lag is None
        assert r.per_speed_squared is None


def test_a_ripple_that_falls_from_day_to_day_is_told_and_a_steady_one_is_not():
    days = [seen(v, 1.0, day * DAY, gain=1 - 0.02 * day) for day in range(5) for v in SPEEDS]
    two, seven = _laws("tau_l", days, True)
    assert two.per_day is not None
    assert seven.per_day is not None
    assert two.per_day[0] == pytest.approx(-0.02, abs=0.002)
    assert abs(seven.per_day[0]) < 2 * seven.per_day[1]


def test_noise_alone_has_no_orders():
    quiet = [Seen(v, 1.0, 0.0, seen(v, 1.0).phasors * 0 + NOISE * 0.7, NOISE) for v in SPEEDS]
    assert _laws("tau_l", quiet, True) == []


def test_every_law_is_a_sentence_with_units():
    for r in _laws("tau_l", [seen(v, load, lag=4e-4) for v in SPEEDS for load in (0.5, 20.0)], True):
        assert "N·m" in r.sentence()
        assert "ms after the angle" in r.sentence()
