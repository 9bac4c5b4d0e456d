"""How late each row was against the grid of its period, from the rows alone: the loop's own table stays its own."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rig.core.channels import Flag

Array = np.ndarray[Any, Any]

EARLY = 0.2  # of a period: by so much a row may come before the grid known so far; it then moves the grid
EXACT = 1e-6  # of a period: the rounding of a time


class Lateness:
    """Deadlines lie whole periods apart; the earliest row so far is the one that was not late at all.

    A row that was a period late or more says so by its flag, and is that of the next deadline; any other lies within a
    period after its own. Where that cannot be, rows are missing here, and the count is taken up again at the nearest.
    """

    def __init__(self, period: float) -> None:
        """`period` s of the loop; 0 when nobody knows it: then nothing can be said."""
        self._period = period
        self._origin = math.nan  # s, of deadline 0
        self._next = 0  # the number of the next row's deadline
        self._skipped = 0  # deadlines the loop left out after the row before, by that row's lateness

    def add(self, t: Array, flags: Array) -> Array:
        """Lateness of the next rows [s], shape (n,); never negative, NaN without a period."""
        if not self._period or not len(t):
            return np.full(len(t), np.nan)
        if math.isnan(self._origin):
            self._origin = float(t[0])
        missed = (flags & Flag.MISSED) != 0
        late = np.empty(len(t))
        at = 0
        while at < len(t):
            at = self._stretch(t, missed, at, late)
        earlier = min(float(late.min()), 0.0)
        self._origin += earlier
        return np.asarray(np.round(late - earlier, 7))  # s: what is left below is the rounding of t itself

    def _stretch(self, t: Array, missed: Array, at: int, late: Array) -> int:
        """Rows from `at` on whose deadlines follow each other; the first row that is no longer one of them."""
        first = self._next
        if missed[at]:
            first += self._skipped
        elif self._skipped or not self._fits(float(t[at] - self._origin - first * self._period)):
            first = max(first, math.floor((t[at] - self._origin) / self._period + EARLY))
        k = first + np.arange(len(t) - at)
        found = t[at:] - self._origin - k * self._period
        apart = ~((found >= -EARLY * self._period) & ((found < self._period) | missed[at:]))
        apart[1:] |= missed[at:-1]  # which deadline comes after skipped ones is seen from the row itself
        apart[0] = False
        count = int(np.argmax(apart)) if apart.any() else len(k)
        late[at : at + count] = found[:count]
        self._next = int(k[count - 1]) + 1
        self._skipped = int(found[count - 1] / self._period + EXACT) if missed[at + count - 1] else 0
        return at + count

    def _fits(self, late: float) -> bool:
        return -EARLY * self._period <= late < self._period
