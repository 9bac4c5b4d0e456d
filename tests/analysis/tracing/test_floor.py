"""The floor is the noise of one run, whatever the repeats have in common and however they drift apart in time."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor.neighbours import neighbours, turn_by_turn
from rig.analysis.tracing.floor.repeats import autocorrelation, compare, effective, freedom, output_turns
from rig.analysis.tracing.runs.strokes import strokes


def _noise(rng: np.random.Generator, n: int, sigma: float) -> np.ndarray:
    return sigma * rng.standard_normal(n)


def alone(channel: str, theta: np.ndarray, locked: bool = False, count: float = 0.0) -> Any:
    """Equations of one run alone, whose encoder of the load has that count [rad]."""
    run = SimpleNamespace(locked=locked, ratio=50.0, step_m=0.0, step_l=count)
    return SimpleNamespace(rows={(0, channel): SimpleNamespace(theta_m=theta)}, runs=[run])


def test_what_repeats_at_equal_angle_is_no_noise(rng: np.random.Generator) -> None:
    a, b = np.linspace(0, 60, 6000), np.linspace(0.3, 61, 5900)  # the second one turns a little slower
    d = compare(a, np.sin(a) + _noise(rng, a.size, 0.1), b, np.sin(b) + _noise(rng, b.size, 0.1))
    assert np.sqrt(np.mean(d**2)) == pytest.approx(0.1, rel=0.05)


def test_a_high_order_that_every_turn_repeats_is_no_noise_of_a_fast_run(rng: np.random.Generator) -> None:
    """Of 19 rows a turn a straight line between two misses all of an order 13, as a housing's resonance leaves it."""
    a, b = np.linspace(0, 450, 1220), np.linspace(0.3, 452, 1220)
    wave = [2.0 * np.sin(13 * x) + np.cos(9 * x) + _noise(rng, x.size, 0.1) for x in (a, b)]
    assert np.sqrt(np.mean(compare(a, wave[0], b, wave[1]) ** 2)) == pytest.approx(0.1, rel=0.1)
    eq = alone("A", a)
    found = turn_by_turn(eq, {(0, "A"): wave[0]}, (0, "A"))
    assert found is not None
    assert found.rms == pytest.approx(0.1, rel=0.1)
    swells = [(1.0 + x / 450) * np.sin(2 * x) + _noise(rng, x.size, 0.1) for x in (a, b + 225)]
    assert np.sqrt(np.mean(compare(a, swells[0], b, swells[1]) ** 2)) > 0.2  # what differs between turns is


@pytest.mark.parametrize("locked", [False, True])
def test_an_error_of_no_angle_is_no_noise_of_a_run_alone_unless_nothing_turns(
    locked: bool, rng: np.random.Generator
) -> None:
    """A beat of two clocks, 4.6 times in a run: no two turns have the same of it, and no sensor is as noisy. Of
    a locked run nobody knows what repeats, of a torque it may be friction that wanders, of few counts their beat."""
    theta, t = np.linspace(0, 450, 1200), np.linspace(0, 8, 1200)
    e = 2.0 * (0.573 * t % 1.0 - 0.5) + _noise(rng, t.size, 0.02)
    made = {
        "sensors": turn_by_turn(alone("A", theta, locked), {(0, "A"): e}, (0, "A")),
        "coarse": turn_by_turn(alone("A", theta, locked, count=1.0), {(0, "A"): e}, (0, "A")),
        "torque": turn_by_turn(alone("M", theta, locked), {(0, "M"): e}, (0, "M")),
    }
    rms = {name: found.rms for name, found in made.items() if found}
    swollen = {name for name, found in made.items() if found and found.swollen > 2.0}
    assert swollen == (set() if locked else {"sensors"})
    assert rms["torque"] == rms["coarse"] > 0.25
    assert rms["sensors"] == (rms["torque"] if locked else pytest.approx(6 * 0.02, rel=0.15))


def test_strokes_are_compared_with_strokes_of_their_own_direction(rng: np.random.Generator) -> None:
    there = np.linspace(0, 20, 2000)
    theta = np.concatenate([there, there[::-1], there])
    assert len(strokes(theta)) == 3
    backlash = np.where(np.gradient(theta) > 0, 5.0, -5.0)
    d = compare(theta, backlash + _noise(rng, theta.size, 0.1), theta, backlash + _noise(rng, theta.size, 0.1))
    assert np.sqrt(np.mean(d**2)) < 0.5  # far below the 10 between directions


def test_one_cycle_about_where_it_began_is_compared_turn_by_turn(rng: np.random.Generator) -> None:
    """Up, down past the start, up to it again: the two ways up share no angle."""
    theta = np.concatenate([np.linspace(0, 25, 3000), np.linspace(25, -25, 6000), np.linspace(-25, 0, 3000)])
    e = np.sin(2 * theta) + _noise(rng, theta.size, 0.1)
    eq = alone("M", theta)
    assert neighbours(eq, {(0, "M"): e}, (0, "M")) is None
    found = turn_by_turn(eq, {(0, "M"): e}, (0, "M"))
    assert found is not None
    assert found.rms == pytest.approx(0.1, rel=0.05)


def test_slow_noise_has_fewer_independent_rows(rng: np.random.Generator) -> None:
    white = rng.standard_normal(20000)
    slow = np.convolve(white, np.ones(8), mode="valid")
    assert effective(autocorrelation(white)) < 1.3
    assert effective(autocorrelation(slow)) == pytest.approx(8.0, rel=0.2)


def test_repeats_that_began_elsewhere_are_compared_after_whole_turns_of_the_output() -> None:
    theta = np.linspace(0.0, 400.0, 4000)
    shift = output_turns(theta, theta + 2 * np.pi * 130, 50.0)
    assert shift == pytest.approx(-2 * np.pi * 150)  # 3 turns of the output are nearer than 2
    assert output_turns(theta, theta + 2 * np.pi * 130, 50.25) == 0.0


def test_a_gain_that_is_never_twice_the_same_has_few_degrees_of_freedom(rng: np.random.Generator) -> None:
    square = np.sign(np.sin(np.linspace(0, 12 * np.pi, 6000)))
    assert freedom(square + _noise(rng, 6000, 0.1)) < 4
    assert freedom(_noise(rng, 6000, 1.0)) > 1000
