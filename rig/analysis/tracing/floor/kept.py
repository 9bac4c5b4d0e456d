"""A jump where the motor turns back, which is kept when it has turned back once more: counts that were lost just then.
What has memory or play makes one at every reversal, and goes back over it at the next."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rig.analysis.tracing.floor.jumps import ONE, WINDOW, jumps, without
from rig.analysis.tracing.thresholds import STEP
from rig.model.effect import Array

REACH = 2 * WINDOW  # rows after a reversal in which the motor may still be slow


def kept(e: Array, theta: Array, found: Sequence[tuple[int, float]]) -> list[tuple[int, float]]:
    """Rows of a run and sizes [rad] of jumps beside those `found` in `e` (n,), at most one for each reversal of the
    motor's angle `theta` (n,) but the last."""
    left, back = without(e, found), _reversals(theta)
    near = np.zeros(e.size, bool)
    for at in back[:-1]:
        near[max(at - REACH, 0) : at + 3 * REACH] = True
    seen = jumps(left, near, STEP, (0.0, np.inf))
    return [(row, size) for row, size in seen if _is_kept(left, row, size, back)]


def _reversals(theta: Array) -> list[int]:
    """Rows at which the motor turned back, and went on that way."""
    way = np.sign(theta[REACH:] - theta[:-REACH])
    moving = np.flatnonzero(way)
    turned = np.flatnonzero(np.diff(way[moving]))
    return [int(moving[i + 1]) + REACH // 2 for i in turned]


def _is_kept(e: Array, row: int, size: float, back: Sequence[int]) -> bool:
    """Whether after the next reversal, and to the end, `e` is as far off what was before it."""
    after = next((at + REACH for at in back if at > row + REACH), e.size)
    if e.size - after < WINDOW or row < 2 * WINDOW:
        return False
    return bool(ONE < float(e[after:].mean() - e[: row - WINDOW].mean()) / size < 1 / ONE)
