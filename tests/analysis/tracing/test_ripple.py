"""What one angle and one torque can say: laws of the ripple are given back, and none is made up."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from rig.analysis.tracing.outcome.ripple import DAY, HIGHEST, LATEST, Seen, _laws, of_run

SPEEDS = (6.0, 12.0, 20.0, 31.0, -20.0, -31.0)
NOISE = 1e-3


def seen(
    rng: np.random.Generator, speed: float, load: float, start: float = 0.0, lag: float = 0.0, gain: float = 1.0
) -> Seen:
    """Order 2 of 0.2 N·m, 10 mN·m more per N·m, 50 µN·m more per (rad/s)², read `lag` late; order 7 of 30 mN·m."""
    phasors = NOISE * (rng.standard_normal(HIGHEST) + 1j * rng.standard_normal(HIGHEST)) / np.sqrt(2)
    phasors[1] += gain * (0.2 + 0.01 * load + 5e-5 * speed**2) * np.exp(0.7j - 2j * speed * lag)
    phasors[6] += 0.03 * np.exp(-7j * speed * lag)
    return Seen(speed, load, start, phasors, NOISE)


@pytest.mark.slow
def test_constant_load_and_speed_parts_and_the_lag_come_back(rng: np.random.Generator):
    two, seven = _laws("tau_l", [seen(rng, v, load, lag=4e-4) for v in SPEEDS for load in (0.5, 20.0)], True)
    assert (two.order, seven.order) == (2, 7)
    assert two.constant == pytest.approx(0.2, rel=0.02)
    assert two.per_load == pytest.approx(0.01, rel=0.02)
    assert two.per_speed_squared == pytest.approx(5e-5, rel=0.05)
    assert two.lag is not None
    assert two.lag[0] == pytest.approx(4e-4, abs=2 * two.lag[1])
    assert two.lag[1] < 5e-5


@pytest.mark.slow
@pytest.mark.long
def test_intervals_of_the_amplitudes_cover_and_are_no_wider_than_they_have_to_be():
    true = {"constant": 0.2, "per_load": 0.01, "per_speed_squared": 5e-5}
    off = {name: [] for name in true}
    for seed in range(60):
        rng = np.random.default_rng(seed)
        two, _ = _laws("tau_l", [seen(rng, v, load) for v in SPEEDS for load in (0.5, 20.0)], True)
        for name, value in true.items():
            off[name].append((getattr(two, name) - value) / two.halves[name])
    for of in off.values():
        assert np.mean(np.abs(of) <= 1) >= 0.9  # 95 %, and noise of both parts is half of what is said here
        assert np.sqrt(np.mean(np.square(of))) > 0.2


def test_one_speed_has_no_law_of_speed_and_no_lag(rng: np.random.Generator):
    (two, _) = _laws("tau_l", [seen(rng, 12.0, load) for load in (0.5, 5.0, 20.0)], True)
    assert two.per_speed_squared is None
    assert two.lag is None
    assert two.per_load == pytest.approx(0.01, rel=0.05)


def test_without_time_nothing_is_said_of_speed(rng: np.random.Generator):
    for r in _laws("tau_l", [seen(rng, v, 1.0) for v in SPEEDS], False):
        assert r.lag is None
        assert r.per_speed_squared is None


@pytest.mark.slow
def test_a_ripple_that_falls_from_day_to_day_is_told_and_a_steady_one_is_not(rng: np.random.Generator):
    days = [seen(rng, v, 1.0, day * DAY, gain=1 - 0.02 * day) for day in range(5) for v in SPEEDS]
    two, seven = _laws("tau_l", days, True)
    assert two.per_day is not None
    assert seven.per_day is not None
    assert two.per_day[0] == pytest.approx(-0.02, abs=0.002)
    assert abs(seven.per_day[0]) < 2 * seven.per_day[1]


def test_noise_alone_has_no_orders(rng: np.random.Generator):
    quiet = [Seen(v, 1.0, 0.0, seen(rng, v, 1.0).phasors * 0 + NOISE * 0.7, NOISE) for v in SPEEDS]
    assert _laws("tau_l", quiet, True) == []


@pytest.mark.slow
def test_every_law_is_a_sentence_with_units(rng: np.random.Generator):
    for r in _laws("tau_l", [seen(rng, v, load, lag=4e-4) for v in SPEEDS for load in (0.5, 20.0)], True):
        assert re.search(r" run(s)?: \S+ ± \S+ N·m, \S+ ± \S+ mN·m more per N·m of load, \S+ ± \S+ mN·m", r.sentence())
        assert "ms after the angle" in r.sentence()


def test_a_lag_that_no_phase_tells_is_not_given():
    alike = [Seen(v, 1.0, 0.0, np.where(np.arange(HIGHEST) == 1, 0.2, 0.0).astype(complex), NOISE) for v in SPEEDS]
    scrambled = [Seen(s.speed, 1.0, 0.0, s.phasors * np.exp(1j * k**2), NOISE) for k, s in enumerate(alike)]
    for r in _laws("tau_l", scrambled, True):
        assert r.lag is None or (abs(r.lag[0]) <= LATEST and r.lag[1] < LATEST)
    (far,) = _laws("tau_l", [seen_once(v, 3 * LATEST) for v in (6.0, 7.0, 9.5, -6.5)], True)
    assert far.lag is None or abs(far.lag[0]) <= LATEST


def seen_once(speed: float, lag: float) -> Seen:
    phasors = np.zeros(HIGHEST, dtype=complex)
    phasors[1] = 0.2 * np.exp(-2j * speed * lag)
    return Seen(speed, 1.0, 0.0, phasors, NOISE)


def turning(rows_a_turn: float, torque):
    """A run of 80 turns of the motor, most of one of the output; `torque` of the motor's angle."""
    theta = 2 * np.pi * np.arange(int(80 * rows_a_turn)) / rows_a_turn
    piece = SimpleNamespace(
        t=theta, theta_m=theta, tau_l=torque(theta), way=np.ones(theta.size), omega_m=np.full(theta.size, 70.0)
    )
    return SimpleNamespace(pieces=(piece,), has=frozenset({"tau_l", "t"}), locked=False, ratio=100.0, start=0.0)


@pytest.mark.parametrize(("declared", "way", "speed"), [(600.0, 1.0, 62.8), (600.0, -1.0, -62.8), (0.0, 1.0, 0.0)])
def test_without_time_the_speed_is_what_is_declared(declared: float, way: float, speed: float):
    run = turning(22.3, np.cos)
    run.has, run.speed_rpm = frozenset({"theta_m", "tau_l"}), declared
    run.pieces[0].way *= way
    found = of_run(run, "tau_l")
    assert found is not None
    assert found.speed == pytest.approx(speed, abs=0.05)


def test_orders_with_too_few_rows_a_turn_are_not_looked_for():
    noise = np.random.default_rng(5)
    found = of_run(turning(22.3, lambda x: 0.1 * np.cos(2 * x) + 0.01 * noise.standard_normal(x.size)), "tau_l")
    assert found is not None
    assert np.isfinite(found.phasors).sum() == 7
    assert abs(found.phasors[1]) == pytest.approx(0.1, rel=0.02)
    assert [r.order for r in _laws("tau_l", [found], True)] == [2]
    assert "1 run:" in _laws("tau_l", [found], True)[0].sentence()
    assert of_run(turning(2.5, np.cos), "tau_l") is None


def test_the_weight_of_a_load_is_no_ripple_of_the_motor():
    found = of_run(turning(37.0, lambda x: 70 * np.cos(x / 100 + 0.3)), "tau_l")
    assert found is not None
    assert np.nanmax(np.abs(found.phasors)) < 1e-6
