"""The bench itself: what it calls met, whose turn it is, that a floor computes what it stands beside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.bench.__main__ import by_hand
from tests.bench.built import Unavailable
from tests.bench.figure import AtLeast, AtMost, Figure, Shown, not_measured, ratio
from tests.bench.rows import ROWS
from tests.bench.slow_run import SlowRun
from tests.bench.table import Measured, lines_of
from tests.bench.turns import take_turns


def test_the_median_of_the_rounds_decides() -> None:
    assert Figure("a", [0.5, 0.9, 2.0], AtMost(1.0)).verdict() == "met"
    assert Figure("a", [0.5, 1.1, 2.0], AtMost(1.0)).verdict() == "not met"
    assert Figure("a", [150.0, 250.0, 300.0], AtLeast(200.0)).verdict() == "met"
    assert Figure("a", [1.0], Shown()).verdict() == ""


def test_a_ratio_is_taken_round_by_round() -> None:
    """Ours and theirs both three times slower in one round: the machine's doing, not ours."""
    assert list(ratio("a", [1.0, 3.0], [2.0, 6.0], AtMost(1.0)).values) == [0.5, 0.5]


def test_sides_take_turns_and_the_first_round_does_not_count() -> None:
    order: list[str] = []
    sides = {name: lambda name=name: float(order.append(name) or len(order)) for name in "ab"}
    cost = take_turns(sides, 2)
    assert order == ["a", "b", "a", "b", "b", "a"]
    assert cost == {"a": [3.0, 6.0], "b": [4.0, 5.0]}


def test_what_could_not_be_measured_stands_in_the_table_with_its_reason() -> None:
    row = ROWS[0]()
    (line,) = lines_of(Measured(row, [not_measured("over diffrax", AtMost(0.25), "no wheel")], 1.0, 2.0))
    assert "not measured (no wheel)" in line
    assert "≤ 0.25" in line


def test_what_people_wrote_below_a_table_stays_below_the_next_one(tmp_path: Path) -> None:
    table = tmp_path / "TABLE.md"
    assert by_hand(table) == ""
    table.write_text("# Measured\n\n| 1 |\n\n## By hand\n\nWhy.\n\n## More\n")
    assert by_hand(table) == "\n## By hand\n\nWhy.\n\n## More\n"


def test_rows_are_numbered_once_and_in_order() -> None:
    numbers = [row.number for row in ROWS]
    assert numbers == sorted(set(numbers))


@pytest.mark.long
def test_kernel_and_floor_follow_the_same_equations() -> None:
    """Through a reversal of the slow run: a thousandth of its kinematic error apart, the floor at 16 steps a tick."""
    slow = SlowRun.of(30.0)
    try:
        floor = slow.by_floor(sub=16)()
    except Unavailable as why:
        pytest.skip(str(why))
    ours = slow.by_kernel()
    assert np.ptp(ours) > 1e-4
    assert np.max(np.abs(ours - floor)) < 1e-3 * np.ptp(ours)
