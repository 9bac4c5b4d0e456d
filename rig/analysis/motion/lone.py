"""Single readings that stand far off those beside them: a bit that flipped, a frame that broke. No gear does that."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.core.rows import stretches

Index = npt.NDArray[np.int64]

SIGMA: Final = 1.4826  # of normal noise, over its median size
SMOOTH: Final = 0.01  # of the way from row to row, σ at least: made-up motion without noise has bends all the same
A_ROW: Final = 1.5  # of that way: what is off by a row or less is at a reversal, or a row read twice
FAR: Final = 30.0  # σ of what a reading is off the line between its neighbours: noise has 6 in a year of rows
WIDEST: Final = 3  # rows; what lasts longer has a course, and may be the rig's own
OUTSTANDING: Final = 8.0  # times as far off as any reading beside it: a step and a corner take those along
RARE: Final = 1e-3  # of the rows: readings that often off are how this sensor reads
FEWEST: Final = 5  # of them at any rate, so that a short run may have one or two
BESIDE: Final = 6  # rows on either side, that say where the channel was and is
LOOKED_AT: Final = (200, 100)  # places, and rows at each, from which σ is taken
NONE: Final[Index] = np.empty(0, np.int64)


def lone(x: Array, t: Array | None, period: float = np.inf) -> tuple[Index, Array]:
    """Rows of `x`, (n,), that stand alone, and how far each is off its neighbours, (k,); `t` s, (n,), or None.

    Behind them the channel goes on as before, which tells them from a step. What is off by whole `period`s is wrapped.
    """
    far = _far(x, t)
    rows = [some.start + np.flatnonzero(np.abs(_off(x, t, some)) > far) for some in stretches(x.size)]
    found = np.concatenate([NONE, *rows])
    most = max(int(RARE * x.size), FEWEST)
    if not 0 < found.size <= (WIDEST + 2) * most:  # neighbours of one that is off are off too
        return NONE, np.empty(0)
    groups = np.split(found, np.flatnonzero(np.diff(found) > WIDEST) + 1)
    alone = [_alone(x, t, int(group[0]), int(group[-1]), far, period) for group in groups]
    where, off = (np.concatenate(part) for part in zip(*alone, strict=True))
    return (where, off) if where.size <= most else (NONE, np.empty(0))


def _off(x: Array, t: Array | None, some: slice) -> Array:
    """What the rows of `some` are off the line between their neighbours; NaN where one of the three is missing."""
    out = np.full(some.stop - some.start, np.nan)
    lo, hi = max(some.start - 1, 0), min(some.stop + 1, x.size)
    if hi - lo > 2:
        before, here, after = x[lo : hi - 2], x[lo + 1 : hi - 1], x[lo + 2 : hi]
        share = 0.5 if t is None else (t[lo + 1 : hi - 1] - t[lo : hi - 2]) / (t[lo + 2 : hi] - t[lo : hi - 2])
        out[lo + 1 - some.start : hi - 1 - some.start] = here - before - share * (after - before)
    return out


def _far(x: Array, t: Array | None) -> float:
    """What a reading must be off its neighbours by: far beyond what a usual one is, and more than a row's way."""
    places, rows = LOOKED_AT
    starts = np.unique(np.linspace(0, max(x.size - rows, 0), places).astype(np.int64)).tolist()
    some = [slice(at, min(at + rows, x.size)) for at in starts]
    off = np.abs(np.concatenate([_off(x, t, one) for one in some]))
    off = off[np.isfinite(off)]
    steps = np.abs(np.concatenate([np.diff(x[one]) for one in some]))
    steps = steps[np.isfinite(steps)]
    way = float(np.median(steps)) if steps.size else 0.0
    sigma = max(SIGMA * float(np.median(off)) if off.size else 0.0, SMOOTH * way)
    if sigma > 0.0:
        return max(FAR * sigma, A_ROW * way)
    return FAR * float(np.min(steps[steps > 0.0], initial=np.inf))  # of a sensor that mostly rests: its smallest step


def _alone(x: Array, t: Array | None, first: int, last: int, far: float, period: float) -> tuple[Index, Array]:
    """Those of the rows about `first` to `last` that stand alone, and how far; none where the channel does not go on as
    before. At its ends the rows of one side tell."""
    rows = np.arange(max(first - BESIDE, 0), min(last + BESIDE + 1, x.size))
    if last - first > WIDEST + 1 or rows.size < BESIDE + 2 or not np.isfinite(x[rows]).all():
        return NONE, np.empty(0)
    clock = (rows if t is None else t[rows]) - (rows[0] if t is None else t[rows[0]])
    beside = (rows < first - 1) | (rows > last + 1)
    off = x[rows] - np.polyval(np.polyfit(clock[beside], x[rows][beside], 2), clock)
    least = max(far, OUTSTANDING * float(np.max(np.abs(off[beside]))))
    bad = ~beside & (np.abs(off) > least)
    turns = np.round(off[bad] / period)
    wrapped = (turns != 0) & (np.abs(off[bad] / period - turns) < least / period)
    if wrapped.any() or np.count_nonzero(bad) > WIDEST:
        return NONE, np.empty(0)
    return rows[bad], off[bad]
