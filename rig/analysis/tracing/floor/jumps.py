"""Sharp jumps of a residual that last, of one run: alone, and where one stands in the window of the next."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.thresholds import STEP_AGAIN
from rig.model.effect import Array

Mask = npt.NDArray[np.bool_]

WINDOW: Final = 40  # rows before and after a step: a third of a second, shorter than the wander of an output
FAR: Final = 4 * WINDOW  # rows: a longer window, over which wander counts less
LONG: Final = 50 * WINDOW  # rows: a few turns of the motor, which the size of a jump is taken from
EDGE: Final = 3  # rows over which the low-pass spreads a step
SHORTER: Final = (WINDOW // 2, WINDOW // 4)  # windows for jumps between others
OTHERS: Final = (*SHORTER, FAR)  # and one for what stands alone, and is too small for the usual window to tell its size
ROUNDS: Final = 40  # jumps found between others, at most
ONE: Final = 0.65  # of the usual size: the least that one loss may be
TWO: Final = 2.7  # of the usual size: the most that two at a time may be


def jumps(
    e: Array, onward: Mask, least: float, between: tuple[float, float], window: int = WINDOW
) -> list[tuple[int, float]]:
    """Row and size of every jump: means of `window` rows on both sides differ, nearly all of it at once and for good.

    `least` in usual differences of such windows, size `between` two bounds [rad]; only where the motor goes `onward`.
    """
    if e.size < 6 * window:
        return []
    total = np.concatenate([[0.0], np.cumsum(e)])
    at = np.arange(window + EDGE, e.size - window - EDGE)
    after = (total[at + EDGE + window] - total[at + EDGE]) / window
    before = (total[at - EDGE] - total[at - EDGE - window]) / window
    jump = after - before
    usual = float(np.median(np.abs(jump))) / 0.6745
    least_far = min(window, WINDOW)
    far = least_far * FAR // WINDOW  # rows as far as which what was lost has not come back
    out: list[tuple[int, float]] = []
    strength = np.abs(jump) / max(usual, 1e-300)
    while strength.size and strength.max() > least:
        top = int(np.argmax(strength))
        row = int(at[top])
        near = e[row + EDGE : row + 4 * EDGE].mean() - e[row - 4 * EDGE : row - EDGE].mean()
        sharp = abs(near - jump[top]) < 0.5 * abs(jump[top])
        stays = (_mean(total, row + least_far, row + far) - _mean(total, row - far, row - least_far)) / jump[top] > 0.5
        if sharp and stays and onward[row] and between[0] <= abs(jump[top]) <= between[1]:
            out.append((row, float(jump[top])))
        strength[max(0, top - window) : top + window] = 0.0
    return out


def among(e: Array, onward: Mask, found: list[tuple[int, float]], usual: float) -> list[tuple[int, float]]:
    """`found` with jumps of once or twice the `usual` size [rad] that stood in each other's windows, or alone."""
    for _ in range(ROUNDS):
        left = e - _stairs(e, found)
        seen = [jump for w in OTHERS for jump in jumps(left, onward, STEP_AGAIN, (ONE * usual, TWO * usual), window=w)]
        new = [jump for jump in seen if all(abs(jump[0] - row) > 2 * EDGE for row, _ in found)]
        if not new:
            break
        found = sorted([*found, max(new, key=lambda jump: abs(jump[1]))])
    return found


def one_of_size(e: Array, rows: Sequence[int], size: float) -> tuple[int, float] | None:
    """Which of `rows` of `e` (n,) parts it best into two means, and how far they are apart, if about `size` [rad]; None
    where not, or where too little is on one side."""
    at = np.array([row for row in rows if SHORTER[0] <= row <= e.size - SHORTER[0]], dtype=int)
    if not at.size:
        return None
    total = np.cumsum(e)
    apart = (total[-1] - total[at - 1]) / (e.size - at) - total[at - 1] / at
    top = int(np.argmax(apart**2 * at * (e.size - at)))
    return (int(at[top]), float(apart[top])) if ONE < apart[top] / size < 1 / ONE else None


def without(e: Array, known: Sequence[tuple[int, float]]) -> Array:
    """What is left of `e` (n,) without jumps of it that are known by now, rows and sizes [rad]."""
    return e - sum((size * (np.arange(e.size) >= row) for row, size in known), np.zeros(e.size))


def heights(e: Array, rows: Sequence[int]) -> list[tuple[float, float]]:
    """How far what is before each of `rows` of `e` (n,) is from what is after it [rad], as far as LONG or the next, and
    the standard error of it. Where a jump is largest some noise is in its size: that window is not the measure."""
    order = sorted(set(rows))
    last, following = dict(zip(order, [0, *order], strict=False)), dict(zip(order, [*order[1:], e.size], strict=True))

    def height(row: int) -> tuple[float, float]:
        before = e[max(last[row] + EDGE, row - LONG) : row - EDGE]
        after = e[row + EDGE : min(following[row] - EDGE, row + LONG)]
        if not (before.size and after.size):
            return float(e[row:].mean() - e[:row].mean()), 0.0
        return float(after.mean() - before.mean()), float(np.hypot(_error(before), _error(after)))

    return [height(row) for row in rows]


def _error(e: Array) -> float:
    """Standard error of the mean of `e` (n,), of whose windows each is as good as independent of the next."""
    count = e.size // WINDOW
    if count < 2:
        return float(np.std(e))
    return float(np.std(e[: count * WINDOW].reshape(count, WINDOW).mean(1), ddof=1) / np.sqrt(count))


def _stairs(e: Array, found: Sequence[tuple[int, float]]) -> Array:
    """The stairs with jumps at those rows that come nearest to `e` (n,): its means between them."""
    edges = [0, *sorted(row for row, _ in found), e.size]
    return np.concatenate([np.full(b - a, e[a:b].mean()) for a, b in itertools.pairwise(edges) if b > a])


def _mean(total: Array, first: int, last: int) -> float:
    """Of rows first..last, as far as there are such, from sums (n + 1,) of all before."""
    lo, hi = (min(max(row, 0), total.size - 1) for row in (first, last))
    return float((total[hi] - total[lo]) / max(hi - lo, 1))
