"""A gap in the rows: told, never a turn, and no reason to take an angle for a wrapped one."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.motion.angle import NONE, is_wrapped, joined, unwrap
from rig.analysis.motion.gaps import find_gaps, that_matter
from rig.core.units import TURN

T = np.arange(20_000) * 1e-3  # s
THETA = 5.0 * TURN * T  # rad, 300 rpm


def _without(first: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    keep = np.r_[0:first, first + rows : T.size]
    return T[keep], THETA[keep]


@pytest.mark.parametrize("rows", [60, 200, 3200])
def test_a_gap_is_found_and_told_with_its_start_and_length(rows: int) -> None:
    t, theta = _without(9000, rows)
    gaps = that_matter(find_gaps(t, timed=True), theta)
    assert gaps.before.tolist() == [9000]
    assert len(gaps.words) == 1
    assert gaps.words[0].startswith(f"gap of {(rows + 1) * 1e-3:.3g} s at t = ")


def test_rows_that_a_fit_bridges_are_no_gap() -> None:
    t, theta = _without(9000, 2)
    assert not that_matter(find_gaps(t, timed=True), theta).words
    assert not find_gaps(None, timed=False).before.size


def test_a_missing_block_of_whole_turns_is_no_wrap() -> None:
    t, theta = _without(9000, 199)  # a turn is 200 rows
    assert not is_wrapped(theta), "it goes far beyond a turn"
    short = slice(8900, 9100)  # a turn and a half on either side of a gap of a turn
    gap = find_gaps(t[short], timed=True).before
    assert gap.tolist() == [100]
    assert is_wrapped(theta[short]), "by the angle alone the step could be a wrap"
    assert not is_wrapped(theta[short], gap)
    assert is_wrapped(np.mod(theta, TURN), find_gaps(t, timed=True).before)
    assert is_wrapped(np.mod(THETA, TURN), NONE)


def test_the_turns_a_wrapped_angle_made_in_a_gap_are_those_of_the_load() -> None:
    t, theta = _without(9000, 3210)
    gaps = find_gaps(t, timed=True).before
    back = joined(unwrap(np.mod(theta, TURN), TURN), theta / 50 + 1e-4 * np.sin(theta), 50.0, gaps)
    assert np.allclose(back - back[0], theta - theta[0])
