"""Counts lost again and again: stairs that are sharp, of no angle, and in several runs."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import stairs as module
from rig.analysis.tracing.floor.own import Own, _that_takes_more
from rig.analysis.tracing.floor.stairs import stairs
from rig.analysis.tracing.floor.steps import LOST
from rig.model.effect import Array

ROWS = 600  # five seconds
COUNT = 4.85e-6  # rad, of a load encoder of 1296000 counts
NOISE = 0.5 * COUNT
RUNS = 4


def rig(speeds: list[float]) -> Any:
    """Runs of free loads at those speeds of the output [rad a row]."""
    runs = [SimpleNamespace(locked=False, ratio=50.0) for _ in speeds]
    rows = {(i, "A"): SimpleNamespace(theta_m=50.0 * by * np.arange(ROWS)) for i, by in enumerate(speeds)}
    return SimpleNamespace(runs=runs, rows=rows)


def walk(rng: np.random.Generator, steps: int = 6) -> Array:
    """Two or four counts, either way."""
    at = np.sort(rng.choice(np.arange(30, ROWS - 30, 40), steps, replace=False))
    return sum((COUNT * rng.choice([-4, -2, 2, 4]) * (np.arange(ROWS) >= row) for row in at), np.zeros(ROWS))


def left(made: list[Array], seed: int = 1) -> Any:
    """With noise of the readings."""
    rng = np.random.default_rng(seed)
    return {(i, "A"): x + NOISE * rng.standard_normal(ROWS) for i, x in enumerate(made)}


SPEEDS = [0.004, 0.006, 0.008, 0.01]


def test_counts_that_are_lost_again_and_again_are_found_where_they_were() -> None:
    rng = np.random.default_rng(5)
    walks = [walk(rng) for _ in range(RUNS)]
    found = stairs(rig(SPEEDS), left(walks))
    assert found.keys() == set(range(RUNS))
    for run, made in enumerate(walks):
        true = np.flatnonzero(np.diff(made)) + 1
        assert len(found[run]) == true.size
        assert np.all(np.abs(np.array(found[run]) - true) <= 2)


def saw(period: int, at: int) -> Array:
    """Goes up evenly and falls back at once, as the delay between two clocks does that run apart."""
    return 40 * COUNT * np.mod((np.arange(ROWS) + at) / period, 1.0)


def wave(n: float) -> Array:
    return 20 * COUNT * np.sin(2 * np.pi * n * np.arange(ROWS) / ROWS)


@pytest.mark.parametrize(
    "made",
    [
        [np.zeros(ROWS)] * RUNS,
        [wave(n) for n in (1.0, 2.0, 3.0, 5.0)],  # what waves is drawn better by lines
        [12 * COUNT * (np.arange(ROWS) > 300)] * RUNS,  # one step a run is told by itself
        [walk(np.random.default_rng(3)), *[np.zeros(ROWS)] * (RUNS - 1)],  # one run alone may have had a shock
    ],
)
def test_what_is_no_walk_has_no_stairs(made: list[Array]) -> None:
    assert stairs(rig(SPEEDS), left(made)) == {}


def test_a_scale_put_together_from_pieces_loses_nothing() -> None:
    """It steps at the same angles in every run."""
    pieces = [COUNT * (3 * (np.floor(7 * by * np.arange(ROWS) / (2 * np.pi)) % 2)) for by in (0.02, 0.03, 0.04, 0.05)]
    eq = rig([0.02, 0.03, 0.04, 0.05])
    assert stairs(eq, left(pieces)) == {}
    assert module._of_the_angle(eq, {i: list(np.flatnonzero(np.diff(x)) + 1) for i, x in enumerate(pieces)})


def test_a_run_too_long_for_it_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(5)
    made = left([walk(rng) for _ in range(RUNS)])
    monkeypatch.setattr(module, "LONGEST", ROWS - 1)
    assert stairs(rig(SPEEDS), made) == {}


def test_a_slope_that_falls_back_leans_between_the_steps_it_is_drawn_by() -> None:
    """A delay between two clocks that run apart (exam 106, case 13)."""
    y = left([saw(170, 20)])[0, "A"]
    back = [149, 319, 489]  # and between them it is drawn by small steps
    assert module._leans(y, sorted([0, *range(25, 600, 34), *back, ROWS]))
    made = walk(np.random.default_rng(5))
    assert not module._leans(left([made])[0, "A"], [0, *(np.flatnonzero(np.diff(made)) + 1), ROWS])


def test_a_crest_that_is_drawn_by_two_steps_takes_its_time() -> None:
    """As order 2 leaves it of order 2.04 (exam plant 106, seed 7, case 19)."""
    turns = np.arange(ROWS) / 190
    crests = 25 * COUNT * np.exp(4.0 * (np.cos(2 * np.pi * turns) - 1.0))
    half = np.flatnonzero(np.diff(crests > crests.max() / 2)) + 1
    assert not module._at_once(crests, [0, *half, ROWS])
    made = walk(np.random.default_rng(5))
    y = left([made])[0, "A"]
    assert module._at_once(y, [0, *(np.flatnonzero(np.diff(made)) + 1), ROWS])


def own(columns: Array, many: bool = False) -> Own:
    return Own({LOST.name: {(0, "A"): columns}, "other": {}}, {LOST.name: (), "other": ()}, None, many=many)


def test_stairs_stand_where_they_leave_half_of_what_single_steps_do() -> None:
    noise = np.random.default_rng(6).standard_normal(ROWS)
    y = noise + 2.0 * (np.arange(ROWS) >= 200) + 0.5 * (np.arange(ROWS) >= 400)
    one, two = (np.stack([1.0 * (np.arange(ROWS) >= row) for row in rows], 1) for rows in ((200,), (200, 400)))
    few, many = own(one), own(two, many=True)
    assert _that_takes_more({(0, "A"): y}, many, few) is few  # the second one adds little
    y = y + 3.0 * (np.arange(ROWS) >= 400)
    assert _that_takes_more({(0, "A"): y}, many, few) is many
    assert _that_takes_more({(0, "A"): y}, None, few) is few
    assert _that_takes_more({(0, "A"): y}, many, None) is many
