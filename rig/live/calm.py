"""Which rows of a run tell of the gear: both angles of one moment, and the loop not just back from a stall."""

from __future__ import annotations

import math
from typing import Any, final

import numpy as np

from rig.core.channels import UNTRUSTED, Flag

Array = np.ndarray[Any, Any]

AWAY = 0.02  # s without a row: at 9.6 rpm 10 to 15 ms leave no trace in θ̃, 30 to 50 ms move it by 25 arcsec and more
SETTLES = 0.7  # s: a motor that was let run is pulled back; what that sets ringing takes 37° at 9.6 rpm to die away


@final
class Calm:
    """Fed with every row in order, however they come.

    A row whose motor angle is older than its load angle shows ω·age/N beside the error: 20 arcsec for 5 ms at 9.6 rpm.
    """

    def __init__(self) -> None:
        self._t = math.nan  # s, of the last row with both angles new
        self._missed = 0  # rows before which ticks were missed, up to that one
        self._counted = 0  # and up to the last row of all
        self._until = -math.inf  # s, when the gear has settled after the last stall

    def of(self, t: Array, flags: Array) -> Array:
        """True for each row that tells of the gear, shape (n,), from times [s] and quality bits, each shape (n,)."""
        missed = self._counted + np.cumsum((flags & int(Flag.MISSED)) != 0)
        told = (flags & int(UNTRUSTED)) == 0
        if len(t):
            self._counted = int(missed[-1])
        if not told.any():
            return np.asarray(told)
        times, counts = t[told], missed[told]
        away = (np.diff(times, prepend=self._t) > AWAY) & (np.diff(counts, prepend=self._missed) > 0)
        settled = np.maximum.accumulate(np.where(away, times + SETTLES, self._until))
        self._t, self._missed, self._until = float(times[-1]), int(counts[-1]), float(settled[-1])
        told[told] = times >= settled
        return np.asarray(told)
