"""How late each row was against the grid of its period, from the rows alone: the loop's own table stays its own."""

from __future__ import annotations

from typing import Any

import numpy as np

from rig.core.channels import Flag

Array = np.ndarray[Any, Any]


class Lateness:
    """The k-th deadline lies k periods after the first; the earliest row so far is the one that was not late at all."""

    def __init__(self, period: float) -> None:
        """`period` s of the loop; 0 when nobody knows it: then nothing can be said."""
        self._period = period
        self._origin = np.nan  # s, of deadline 0
        self._next = 0  # the number of the next row's deadline
        self._last = np.nan  # s, when the row before was made

    def add(self, t: Array, flags: Array) -> Array:
        """Lateness of the next rows [s], shape (n,); never negative, NaN without a period."""
        if not self._period or not len(t):
            return np.full(len(t), np.nan)
        if np.isnan(self._origin):
            self._origin, self._last = float(t[0]), float(t[0]) - self._period
        k = self._next + np.arange(len(t)) + self._left_out(t, flags)
        for i in np.flatnonzero(flags & Flag.MISSED):  # deadlines that had passed before this row was made
            k[i + 1 :] += max(int((t[i] - self._origin) / self._period - k[i] + 1e-9), 0)
        late = t - self._origin - k * self._period
        earlier = min(float(late.min()), 0.0)
        self._origin += earlier
        self._next, self._last = int(k[-1]) + 1 + self._skipped(late[-1], flags[-1]), float(t[-1])
        return np.asarray(np.round(late - earlier, 7))  # s: what is left below is the rounding of t itself

    def _left_out(self, t: Array, flags: Array) -> Array:
        """Deadlines of rows this reader never saw: a gap without the loop's word that it missed some."""
        gaps = np.diff(t, prepend=self._last) / self._period
        unseen = np.where((gaps > 1.5) & ~_after_or_at_missed(flags), np.round(gaps) - 1, 0)
        return np.asarray(np.cumsum(unseen).astype(np.int64))

    def _skipped(self, late: float, flags: int) -> int:
        return max(int(late / self._period + 1e-9), 0) if flags & Flag.MISSED else 0


def _after_or_at_missed(flags: Array) -> Array:
    missed = (flags & Flag.MISSED) != 0
    return np.asarray(missed | np.concatenate(([False], missed[:-1])))
