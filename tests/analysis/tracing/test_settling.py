"""What settles anew in every run is told from what goes with the angle, or with the campaign's time."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.residual.binned import Halves, folds
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.settling import settled
from rig.analysis.tracing.selection.sentences import of_the_rest
from rig.model.effect import Array

RUNS, ROWS, STEP, TAU = 12, 800, 0.05, 6.0  # s


def at(time: Array, e: Array, timed: bool = True, way: float | Array = 1.0, fast: float | Array = 5.0) -> Halves:
    run = np.repeat(np.arange(RUNS), ROWS)
    none = np.zeros((time.size, 0))
    angle = {"motor_angle": 5.0 * time, "load_angle": 0.1 * time, "direction": way * np.ones(time.size)}
    angle["speed"] = angle["direction"] * fast
    r = Rest(e, run, {"time": time, **angle}, STEP, none, none[:0], own_zeros=False, timed=timed)
    return Halves(r, folds(r))


def test_a_zero_that_runs_in_with_every_run_is_told_by_one_number(rng: np.random.Generator) -> None:
    since = np.tile(STEP * np.arange(ROWS), RUNS)
    time = since + np.repeat(100.0 * np.arange(RUNS), ROWS)
    e = 5 * np.exp(-since / TAU) + rng.standard_normal(time.size)
    (home,) = settled(at(time, e), "A")
    assert (home.coordinate, home.first) == ("time", True)
    assert home.share > 0.9
    assert "since each run began, with a time constant near 8 s" in of_the_rest(home, 4.0)
    assert settled(at(time, e, timed=False), "A") == []


@pytest.mark.parametrize("once", [True, False])
def test_what_drifts_through_the_campaign_or_comes_and_goes_does_not_settle(
    rng: np.random.Generator, once: bool
) -> None:
    since = np.tile(STEP * np.arange(ROWS), RUNS)
    time = since + np.repeat(100.0 * np.arange(RUNS), ROWS)
    e = 5 * np.exp(-time / 300.0) if once else 5 * np.sin(2 * np.pi * since / 11.0)
    assert settled(at(time, e + rng.standard_normal(time.size)), "A") == []


def test_a_brake_that_drags_from_the_same_second_of_each_run_on_is_told_by_one_number(rng: np.random.Generator) -> None:
    since = np.tile(STEP * np.arange(ROWS), RUNS)
    time, way = since + np.repeat(100.0 * np.arange(RUNS), ROWS), np.repeat(np.resize([1.0, -1.0], RUNS), ROWS)
    e = 3 * way * (since > 5.2) + rng.standard_normal(time.size)
    (home,) = settled(at(time, e, way=way), "M")
    assert (home.coordinate, home.first) == ("time", True)
    assert home.share > 0.9
    assert "since each run began, from about 5 s on" in of_the_rest(home, 4.0)
    assert settled(at(time, e, way=way), "A") == []  # what turns with the way is no angle's zero


def test_a_drag_that_sets_in_anew_in_every_run_is_the_motors_and_told_by_one_number(rng: np.random.Generator) -> None:
    """Oil that foams while it runs, and drains in the pauses."""
    since = np.tile(STEP * np.arange(ROWS), RUNS)
    time, way = since + np.repeat(100.0 * np.arange(RUNS), ROWS), np.repeat(np.resize([1.0, -1.0], RUNS), ROWS)
    fast = np.repeat(np.resize([6.0, 12.0, 30.0, 42.0], RUNS), ROWS)
    e = 8 * way * (fast / 42.0) ** 2 * (1 - np.exp(-since / 7.0)) + rng.standard_normal(time.size)
    (home,) = settled(at(time, e, way=way, fast=fast), "M")
    assert (home.coordinate, home.first) == ("time", True)
    assert home.share > 0.9
    assert "as a drag that settles with a time constant near 8 s" in of_the_rest(home, 4.0)
    assert all("sets in" not in home.said for home in settled(at(time, e, way=way, fast=fast), "L"))
