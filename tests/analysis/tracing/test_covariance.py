"""Intervals of the fit: as wide as runs differ, not as narrow as their rows would have it."""

from collections.abc import Callable

import numpy as np
import pytest

from rig.analysis.tracing.fit.channels import BASELINE
from rig.analysis.tracing.fit.covariance import between_runs, covariance
from rig.analysis.tracing.fit.equations import Bare, Equations, Noise
from rig.analysis.tracing.fit.model import Design, Part, Solution, fit, inverse, normal

RUNS, ROWS, SLOPE = 16, 200, 2.0


def solved(seed: int, gain: float, telling: int = RUNS, runs: int = RUNS) -> Solution:
    """One slope fitted to runs each of which shows it by a `gain` (standard deviation) of its own too large; all but
    the first `telling` of them hardly show it."""
    rng = np.random.default_rng(seed)
    y, parts = {}, {}
    for run in range(runs):
        x = rng.normal(0, 1 if run < telling else 0.03, ROWS)
        y[run, "A"] = SLOPE * (1 + gain * rng.normal()) * x + rng.normal(0, 1, ROWS)
        parts[run, "A"] = (Part(Bare(x[:, None]), np.array([0]), None),)
    eq = Equations((), {}, Noise({"A": 1.0}, {"A": 1.0}, {"A": np.inf}))
    size = len(BASELINE)
    d = Design(eq, (), (), y, {}, parts, np.zeros((size, size)), np.zeros(size))
    gram, right, _ = normal(d, {key: part[0] for key, part in parts.items()})
    return fit(Design(eq, (), (), y, {}, parts, gram, right))


def coverage(gain: float, spread: Callable[[Solution], np.ndarray], telling: int = RUNS) -> float:
    """Share of fits whose 95 % interval holds the slope."""
    inside = 0
    for seed in range(300):
        s = solved(seed, gain, telling)
        inside += abs(s.x[0] - SLOPE) < 1.96 * np.sqrt(spread(s)[0, 0])
    return inside / 300


@pytest.mark.slow
@pytest.mark.long
def test_intervals_cover_where_runs_differ_by_their_gain() -> None:
    assert 0.90 < coverage(0.2, covariance) < 0.99
    assert coverage(0.2, lambda s: inverse(s.gram)) < 0.60  # what rows of independent noise would give


@pytest.mark.slow
@pytest.mark.long
def test_intervals_cover_where_there_is_noise_alone() -> None:
    assert 0.90 < coverage(0.0, covariance) < 0.99


@pytest.mark.long
def test_intervals_cover_where_four_runs_of_sixteen_tell_nearly_all() -> None:
    assert 0.91 < coverage(0.2, covariance, telling=4) < 0.99


def test_of_one_run_pieces_are_left_out() -> None:
    s = solved(1, 0.0)
    key = (0, "A")
    part, y = s.design.parts[key], s.design.y[key]
    empty = Design(s.design.eq, (), (), {key: y}, {}, {key: part}, s.gram * 0, s.right * 0)
    gram, right, _ = normal(empty, {key: part[0]})
    one = fit(Design(empty.eq, (), (), empty.y, {}, empty.parts, gram, right))
    assert 0.3 / np.sqrt(ROWS) < np.sqrt(covariance(one)[0, 0]) < 3 / np.sqrt(ROWS)


@pytest.mark.slow
@pytest.mark.long
def test_what_differs_between_half_a_dozen_runs_is_not_seen_in_their_pieces() -> None:
    """Friction of a run is the same in all its pieces: left out they say that the slope is known, and it is not."""

    def spread(pieces: bool) -> float:
        inside = 0
        for seed in range(300):
            s = solved(seed, 0.2, runs=6)
            more = 0.0 if pieces else between_runs(s)[0]
            inside += abs(s.x[0] - SLOPE) < 1.96 * np.sqrt(covariance(s)[0, 0] + more)
        return inside / 300

    assert spread(pieces=True) < 0.90 < spread(pieces=False) < 0.995


def test_between_runs_adds_to_the_interval_of_few_runs_only() -> None:
    few, many, noise = solved(3, 0.2, runs=6), solved(3, 0.2), solved(3, 0.0, runs=6)
    assert between_runs(few)[0] > 10 * between_runs(noise)[0]
    assert not between_runs(many).any()
    assert not between_runs(solved(3, 0.2, runs=3)).any()
