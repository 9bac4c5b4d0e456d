"""Readings of an angle that were not taken anew: the row says again what the one before it said, and the shaft moved.

An encoder that hangs, a bus that keeps the last frame, a sensor slower than the rows. Such a reading is late, and looks
like kinematic error. A coarse encoder that has not yet come to its next count goes on by one count, not by many; where
a motor sticks and slips the gear's other side rests as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.motion.smallest_step import smallest_step
from rig.core.rows import stretches
from rig.core.units import TURN

Index = npt.NDArray[np.int64]

FAR: Final = TURN / 6  # rad of the motor: no gear winds up so far, 150 N·m on the paper's
DEAD: Final = 0.9  # of the rows: an angle that stood all the time is refused by what it says of the gear's ratio
COUNTS: Final = 3.0  # smallest steps from one new reading to the next: a coarse encoder goes by one or two
OFTEN: Final = 2.0  # times as many repeats as readings a count up or down: of noise there are half as many
GOES_ON: Final = 0.5  # of its way in a usual row: where it rests, the shaft does
RARE: Final = 1e-3  # of the rows that move so: fewer repeats are chance, and move no figure
FEWEST: Final = 20  # repeats at any rate
BESIDE: Final = 10  # rows on either side, at least, from which the way of a row is taken
LONG: Final = 500  # rows of a stay, in which the other side may have turned back
CHANGES: Final = 4.0  # new readings on either side of it
ROWS: Final = 200_000  # from which the smallest step is taken
NONE: Final[Index] = np.empty(0, np.int64)


@dataclass(frozen=True)
class Repeated:
    """Rows of one angle, (n,), that say nothing new; where it stood longest, from row `first` to row `last`."""

    rows: Index
    first: int
    last: int
    of: int  # n

    def words(self, name: str, t: Array | None) -> str:
        """One note for people; `t` s, (n,), or None."""
        if self.first == self.last:
            what = f"{self.rows.size} of {self.of} readings of {name} repeat the one before though the shaft turned"
        else:
            what = f"{name} stood {self._when(t)} though the shaft turned ({self.rows.size} rows in all)"
        return f"{what}: taken as missing."

    def _when(self, t: Array | None) -> str:
        if t is None or not np.isfinite(t[[self.first, self.last]]).all():
            return f"from row {self.first} to {self.last}"
        return f"for {t[self.last] - t[self.first]:.3g} s at t = {t[self.first]:.3f} s"


def repeated(x: Array, other: Array | None, far: float) -> Repeated:
    """Rows of an angle `x`, (n,) rad, that repeat the reading before while the shaft moves.

    Where `other`, (n,) rad, the angle of the gear's other side, goes on by more than `far` meanwhile, however few rows
    that are; and everywhere where repeats come too often for a coarse reading. Without that angle nothing tells.
    """
    if other is None or not any(np.isfinite(other[some]).any() for some in stretches(x.size)):
        return Repeated(NONE, 0, 0, x.size)
    held, changes = _held(x, other, far)
    stood, first, last = _stood(held, x.size)
    return Repeated(np.union1d(stood, _often(x, other, far, changes)), first, last, x.size)


def _held(x: Array, other: Array, far: float) -> tuple[list[tuple[int, int]], int]:
    """First and last row of each stay of `x` through which the other side turned, and how often `x` changed. Gone
    through in stretches: a run of ten hours has as many changes as rows."""
    # it may be wrapped, and rest where it goes from a turn to none
    wrapped = float(np.nanmax(other) - np.nanmin(other)) <= TURN
    found: list[tuple[int, int]] = []
    changes, since = 0, 0
    for some in stretches(x.size):
        before = x[some.start - 1] if some.start else np.nan
        starts = some.start + np.flatnonzero(np.diff(x[some], prepend=before) != 0)
        first, last = np.append(since, starts[:-1]), starts - 1  # of the stays that ended within these rows
        changes += starts.size
        if starts.size:
            found += _turned_through(first, last, other, far, wrapped)
            since = int(starts[-1])
    found += _turned_through(np.array([since]), np.array([x.size - 1]), other, far, wrapped)
    return found, changes


def _turned_through(first: Index, last: Index, other: Array, far: float, wrapped: bool) -> list[tuple[int, int]]:
    """Those stays of several rows, from `first` to `last`, (k,), in which the other side went on by more than `far`."""
    long = last > first
    first, last = first[long], last[long]
    went = other[last] - other[first]
    if wrapped:
        went = (went + TURN / 2) % TURN - TURN / 2
    for i in np.flatnonzero(last - first > LONG):  # there and back it went nowhere; a held gear winds up either way
        way = other[first[i] : last[i] + 1]
        way = way[np.isfinite(way)]
        went[i] = max(np.abs(went[i]), np.ptp(np.unwrap(way) if wrapped else way) / 2) if way.size else 0.0
    there = np.abs(went) > far
    return list(zip(first[there].tolist(), last[there].tolist(), strict=True))


def _stood(held: list[tuple[int, int]], size: int) -> tuple[Index, int, int]:
    """Rows of those stays but for the first of each, and the first and last row of the longest; none where they are
    most of a run of `size` rows."""
    rows = [np.arange(first + 1, last + 1) for first, last in held]
    if not rows or sum(some.size for some in rows) > DEAD * size:
        return NONE, 0, 0
    return np.concatenate(rows), *max(held, key=lambda stay: stay[1] - stay[0])


def _often(x: Array, other: Array, far: float, changes: int) -> Index:
    """Repeats among rows that move by several steps from one new reading to the next, where they are no chance and the
    other side goes on in them as it does in the rest."""
    count = smallest_step(x[:ROWS])
    beside = int(max(BESIDE, CHANGES * x.size / max(changes, 1)))
    if not count:
        return NONE
    found, moving, near, went = [NONE], 0, 0, np.zeros(2)
    for some in stretches(x.size):
        lo, hi = max(some.start, beside + 1), min(some.stop, x.size - beside)
        if hi <= lo:
            continue
        fast, step, way = _fast(x[lo - beside - 1 : hi + beside], beside, COUNTS * count)
        along = np.sign(way) * np.diff(other[lo - 1 : hi])
        again = fast & (step == 0)
        found.append(lo + np.flatnonzero(again))
        moving += int(np.count_nonzero(fast))
        near += int(np.count_nonzero(fast & (step > 0) & (step < 1.5 * count)))
        went += np.nansum(along[again]), np.nansum(along[fast])
    rows = np.concatenate(found)
    if rows.size <= max(FEWEST, RARE * moving, OFTEN * near) or went[1] < far:
        return NONE  # beside a held output, whose noise goes nowhere, a motor sticks
    return rows if went[0] / rows.size > GOES_ON * went[1] / moving else NONE


def _fast(x: Array, beside: int, far: float) -> tuple[npt.NDArray[np.bool_], Array, Array]:
    """Of the rows of `x`, (n + 2·beside + 1,), but for `beside` + 1 before and `beside` behind: which move on both
    sides by more than `far` from one new reading to the next, how far each is from the row before, and the
    way across both sides, each (n,)."""
    step = np.abs(np.diff(x))
    news = np.cumsum(np.append(0, step != 0))
    n = x.size - 2 * beside - 1
    at = [slice(first, first + n) for first in (1, beside + 1, 2 * beside + 1)]  # before, here, behind
    sides = [(x[b] - x[a], news[b] - news[a]) for a, b in pairwise(at)]
    moves = [np.abs(way) > far * np.maximum(changes, 1) for way, changes in sides]
    return moves[0] & moves[1], step[beside : beside + n], sides[0][0] + sides[1][0]
