"""Rows to whole turns of the wave generator, each averaged over equal parts of the turn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from rig.core.units import TURN

Array = np.ndarray[Any, Any]

BINS = 360  # of a turn: a picture is hardly wider
GAP = 1 / 8  # of a turn that may lie between two bins with rows, where a turn counts as seen
HIDING = 1 / 20  # of a turn in which a peak of order 2 loses 5 % at most
LEAVE = TURN / 18  # rad, where it stopped: the gear unwinds there, 30 arcsec and more in the last 20°
RUN_UP = TURN / 4  # rad, before the turn: what a reversal sets ringing takes 37° to settle at the slow run's 9.6 rpm


@dataclass(frozen=True)
class Turn:
    """One turn passed through one way: mean of the rows in each bin, shape (BINS,), NaN where there was none."""

    number: int  # of the motor, from its zero
    way: int  # +1 forward, -1 reverse
    values: Array

    @property
    def peak_to_peak(self) -> float:
        """In the unit of the values; NaN where a peak could hide in a stretch without rows."""
        if _widest_gap(np.isfinite(self.values)) > HIDING:
            return math.nan
        return float(np.nanmax(self.values) - np.nanmin(self.values))


class Turns:
    """Gives a turn once it was left on the side opposite to where it was entered; a reversal has an offset of its own,
    and rings, so a turn with one inside or shortly before it is none.
    """

    def __init__(self) -> None:
        self._number: int | None = None
        self._way = 0  # which way the turn was entered; 0 for the first, begun somewhere inside
        self._first, self._last = math.inf, -math.inf  # rad, least and greatest angle within this turn
        self._run_up = 0.0  # rad, travelled this way before the turn was entered
        self._sum, self._rows = np.zeros(BINS), np.zeros(BINS)

    @property
    def way(self) -> int:
        """Which way the present turn was entered; 0 when nobody saw it."""
        return self._way

    @property
    def partial(self) -> Array:
        """The present turn as far as it was seen, shape (BINS,), NaN elsewhere."""
        with np.errstate(invalid="ignore"):
            return np.asarray(np.where(self._rows > 0, self._sum / np.maximum(self._rows, 1), np.nan))

    @property
    def stopped(self) -> Array:
        """`partial`, without where the motor came to rest, for a run that is over."""
        end = self._last if self._way > 0 else self._first
        if not self._way or not math.isfinite(end):
            return self.partial
        turn = self.partial
        behind = self._way * (end % TURN / TURN * BINS - np.arange(BINS) - 0.5)  # bins
        turn[(behind > -1) & (behind < LEAVE / TURN * BINS)] = np.nan
        return turn

    def add(self, theta: Array, values: Array) -> list[Turn]:
        """Rows of motor angle [rad] and values, each shape (n,), without NaN; the turns they complete."""
        number = np.floor(theta / TURN).astype(np.int64)
        place = np.minimum(((theta / TURN - number) * BINS).astype(np.int64), BINS - 1)
        edges = [0, *(np.flatnonzero(np.diff(number)) + 1), len(theta)]
        done = []
        for a, b in pairwise(edges):
            if b > a:
                done += self._piece(int(number[a]), place[a:b], values[a:b])
                self._first = min(self._first, float(theta[a:b].min()))
                self._last = max(self._last, float(theta[a:b].max()))
        return done

    def _piece(self, number: int, place: Array, values: Array) -> list[Turn]:
        """Rows within one turn."""
        done = self._leave(number) if number != self._number else []
        self._sum += np.bincount(place, values, BINS)
        self._rows += np.bincount(place, minlength=BINS)
        return done

    def _leave(self, number: int) -> list[Turn]:
        before, way = self._number, 0
        if before is not None and abs(number - before) == 1:
            way = number - before
        seen = self._run_up >= RUN_UP and _widest_gap(self._rows) <= GAP
        done = [Turn(before, way, self.partial)] if before is not None and way and way == self._way and seen else []
        self._run_up = self._last - self._first if way else 0.0
        self._first, self._last = math.inf, -math.inf
        self._number, self._way = number, way
        self._sum, self._rows = np.zeros(BINS), np.zeros(BINS)
        return done


def _widest_gap(rows: Array) -> float:
    """The widest stretch of a turn without a row, as a share of the turn."""
    seen = np.flatnonzero(rows)
    if not len(seen):
        return 1.0
    return float((np.diff(seen, append=seen[0] + BINS).max() - 1) / BINS)
