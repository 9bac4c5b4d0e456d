"""Where the motor turned round, and the whole revolutions between."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.core.units import TURN

CUT = TURN / 2  # rad  presliding and the 2·F_cl/K wind-up (0.8° of the motor) are over; half an order-1 period is safe
REVERSAL = TURN / 4  # rad  a motion back by less is hunting, not a reversal
TOLERANCE = 0.02  # turns  a stroke of 7.99 turns counts as 8: the cut then is 0.49 turn instead of 0.5
BLOCKS = 4096  # a run is searched for reversals in this many pieces, whatever its length

Index = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Stroke:
    """One sweep in one direction. `edges` are the rows at which whole revolutions begin and end, (revolutions + 1,)."""

    direction: int  # +1 forward, −1 reverse
    start: int  # first row after the cut
    stop: int  # one past the last row before the cut
    edges: Index

    @property
    def revolutions(self) -> int:
        return len(self.edges) - 1


def turning_points(theta: Array, threshold: float) -> list[int]:
    """Rows at which `theta` [rad] turned round, with the run's first and last extreme, by a hysteresis of `threshold`.

    Noise and hunting smaller than the threshold are ignored. Fewer than two points: it did not move that far.
    """
    size = max(1, -(-theta.size // BLOCKS))
    rows: list[int] = []
    for lo in range(0, theta.size, size):
        piece = theta[lo : lo + size]
        rows.extend(sorted({lo + int(piece.argmin()), lo + int(piece.argmax())}))
    pivots: list[int] = []
    low = high = rows[0]
    direction = 0
    for i in rows:
        v = theta[i]
        if direction >= 0 and v > theta[high]:
            high = i
        if direction <= 0 and v < theta[low]:
            low = i
        if direction >= 0 and theta[high] - v >= threshold:
            pivots.append(high)
            direction, low = -1, i
        elif direction <= 0 and v - theta[low] >= threshold:
            pivots.append(low)
            direction, high = 1, i
    if direction:
        pivots.append(high if direction > 0 else low)
    return pivots


def _moving_at(theta: Array, lo: int, hi: int, end: int, outer: int) -> bool:
    """Whether the motor was already (or still) moving at the row `end` of lo..hi: rows per angle as in the middle. A
    rest may go on as far as the row `outer`: where in it noise is highest is chance."""
    sixteenth = TURN / 16
    progress = np.abs(theta[min(lo, outer) : max(hi, outer) + 1] - theta[end])
    near = int(np.count_nonzero(progress <= sixteenth))
    usual = (hi - lo) * sixteenth / max(abs(float(theta[hi] - theta[lo])), sixteenth)
    return near <= 1.5 * usual + 2


def _stroke(theta: Array, lo: int, hi: int, cut_start: float, cut_end: float) -> Stroke:
    """The stroke between the rows lo and hi (both included), less what is cut at either end [rad]."""
    direction = 1 if theta[hi] > theta[lo] else -1
    # a running maximum is monotonic whatever the noise: crossings are then unique
    progress = np.maximum.accumulate(direction * (theta[lo : hi + 1] - theta[lo]))
    span = float(progress[-1])
    usable = (span - cut_start - cut_end) / TURN
    revolutions = max(int(np.floor(usable + TOLERANCE)), 0)
    # whole revolutions sit as far as they can from an end that was not cut, else in the middle of what is usable
    spare, share = (usable - revolutions) * TURN, 0.5 + 0.5 * (bool(cut_end) - bool(cut_start))
    first = cut_start + spare * share
    marks = first + TURN * np.arange(revolutions + 1)
    edges = lo + np.searchsorted(progress, marks)
    start = lo + int(np.searchsorted(progress, min(cut_start, first)))
    stop = lo + int(np.searchsorted(progress, max(span - cut_end, marks[-1])))
    return Stroke(direction, start, min(stop, hi) + 1, np.minimum(edges, hi).astype(np.int64))


def find_strokes(motion: Motion) -> list[Stroke]:
    """The strokes with at least one whole revolution, in time order.

    Half a turn is cut at every reversal, and where the run began or ended at rest.
    """
    theta = motion.theta_m
    found: list[Stroke] = []
    ends = sorted({0, theta.size, *motion.breaks})
    for begin, end in pairwise(ends):
        if end - begin < 8:
            continue
        pivots = [begin + p for p in turning_points(theta[begin:end], REVERSAL)]
        for k, (lo, hi) in enumerate(pairwise(pivots)):
            first = CUT if k > 0 or not _moving_at(theta, lo, hi, lo, begin) else 0.0
            last = CUT if k < len(pivots) - 2 or not _moving_at(theta, lo, hi, hi, end - 1) else 0.0
            stroke = _stroke(theta, lo, hi, first, last)
            if stroke.revolutions >= 1:
                found.append(stroke)
    return found
