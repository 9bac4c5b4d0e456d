"""Counts lost for good at one place of a disc: told from what comes back, and from what is lost anywhere."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor.scratched import scratched
from rig.analysis.tracing.floor.steps import Steps
from rig.core.units import TURN
from rig.model.effect import Array

N, SIZE, PLACE, ROWS = 50.0, 1.3e-4, -0.1, 4000
CYCLE = 0.5 * np.interp(np.linspace(0, 4, ROWS), [0, 1, 3, 4], [0, 1, -1, 0])  # rad of the output, about zero
FAST = np.linspace(-0.4, 9.0, ROWS)


def made(theta: list[Array], lost: Any) -> tuple[Any, dict[tuple[int, str], Array], Steps]:
    """Runs at those angles of the output, what `lost` makes of each, and the jumps in it."""
    rng = np.random.default_rng(4)
    eq = SimpleNamespace(
        runs=[SimpleNamespace(ratio=N) for _ in theta],
        rows={(i, "A"): SimpleNamespace(theta_m=N * x) for i, x in enumerate(theta)},
    )
    each = [lost(x) for x in theta]
    e = {(i, "A"): x + 0.05 * SIZE * rng.standard_normal(ROWS) for i, x in enumerate(each)}
    rows = {i: tuple(int(at) + 1 for at in np.flatnonzero(np.diff(x))) for i, x in enumerate(each) if np.ptp(x)}
    sizes = {i: tuple(float(each[i][at] - each[i][at - 1]) for at in at_rows) for i, at_rows in rows.items()}
    sides = {i: (0.0,) * len(of) for i, of in rows.items()}
    return eq, e, Steps(rows, sizes, sides, sides)


def forth(theta: Array) -> Array:
    """Counts lost each time the place is passed forth, and kept."""
    turns = np.floor((theta - PLACE) / TURN)
    return SIZE * np.cumsum(np.maximum(np.diff(turns, prepend=turns[0]), 0.0))


def both_ways(theta: Array) -> Array:
    """A scale that was put together from two pieces."""
    return SIZE * (np.floor((theta - PLACE) / TURN) % 2)


def by_the_way(theta: Array) -> Array:
    """A tooth on which the gear sits off by the same, one way alone: it comes down again beyond it."""
    past = np.mod(theta - PLACE, TURN) < 0.2
    return SIZE * (past & (np.gradient(theta) > 0))


RUNS = [CYCLE, CYCLE, FAST, FAST - 0.3, -FAST]


def test_counts_lost_at_one_place_one_way_are_found_and_small_jumps_left_out() -> None:
    eq, e, steps = made(RUNS, forth)
    found = scratched(eq, e, steps)
    assert found is not None
    assert found.rows == steps.rows
    small = Steps(
        {**steps.rows, 4: (700,)}, {**steps.sizes, 4: (0.2 * SIZE,)}, {**steps.sides, 4: (0.0,)},
        {**steps.errors, 4: (0.0,)},
    )  # fmt: skip
    assert scratched(eq, e, small) == found


@pytest.mark.parametrize("lost", [both_ways, by_the_way, lambda theta: SIZE * (np.arange(ROWS) > 1500)])
def test_what_comes_back_or_lies_anywhere_is_no_scratch(lost: Any) -> None:
    eq, e, steps = made(RUNS, lost)
    assert scratched(eq, e, steps) is None


def test_a_place_passed_more_often_than_a_run_jumps_there_is_none() -> None:
    eq, e, steps = made([*RUNS, *[FAST] * 9], lambda theta: forth(theta) if theta is not FAST else np.zeros(ROWS))
    assert scratched(eq, e, steps) is None


def test_where_no_angle_is_passed_before_and_after_nothing_is_known() -> None:
    eq, e, steps = made([np.linspace(-0.4, 0.4, ROWS) + 0.01 * i for i in range(4)], forth)
    assert scratched(eq, e, steps) is None


def test_runs_about_zero_are_told_where_they_end_and_began() -> None:
    """No other angle is passed the same way before and after."""
    eq, e, steps = made([CYCLE] * 4, forth)
    assert scratched(eq, e, steps) is not None
    eq, e, steps = made([CYCLE] * 4, by_the_way)
    assert scratched(eq, e, steps) is None
