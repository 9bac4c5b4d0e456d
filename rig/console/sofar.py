"""What a run shows so far: peak to peak over the last whole motor turn, and how well the motor follows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

ARCSEC = 180.0 / math.pi * 3600.0
DEG = 180.0 / math.pi
TURN = 2.0 * math.pi
RUN_UP = TURN / 4  # rad, before the turn: what a reversal sets ringing takes 37° to settle at the slow run's 9.6 rpm
Rows = np.ndarray[Any, Any]


class SoFar:
    """Fed with every row of the ring, in order. Figures are None before they mean anything."""

    def __init__(self, ratio: float) -> None:
        self.ratio = ratio
        self.peak_to_peak: float | None = None  # arcsec, θ̃ = θ_m/N − θ_l over the last turn passed one way
        self.zero: float | None = None  # rad, θ̃ of the first row
        self.newest = 0.0  # s, t of the last row
        self._turn: int | None = None
        self._entered = 0  # which way this turn was entered; 0 for the first, which began somewhere inside
        self._low = self._high = math.nan
        self._first, self._last = math.inf, -math.inf  # rad, least and greatest motor angle within this turn
        self._run_up = 0.0  # rad, travelled this way before the turn was entered
        self._squares, self._n = 0.0, 0

    @property
    def following(self) -> float | None:
        """Root mean square of reference minus motor angle [deg], over the rows that have a reference."""
        return math.sqrt(self._squares / self._n) * DEG if self._n else None

    def add(self, rows: Rows) -> None:
        """The next rows, shape (n,)."""
        if not len(rows):
            return
        error = rows["theta_m"] / self.ratio - rows["theta_l"]
        if self.zero is None:
            self.zero = float(error[0])
        self.newest = float(rows["t"][-1])
        behind = rows["theta_ref"] - rows["theta_m"]
        behind = behind[~np.isnan(behind)]
        self._squares += float(behind @ behind)
        self._n += len(behind)
        turns = np.floor(rows["theta_m"] / TURN).astype(int)
        for part in np.split(np.arange(len(rows)), np.flatnonzero(np.diff(turns)) + 1):
            self._stretch(int(turns[part[0]]), rows["theta_m"][part], error[part])

    def _stretch(self, turn: int, theta_m: Rows, error: Rows) -> None:
        """Rows within one motor turn. Only a turn passed through one way, well after a reversal, counts."""
        if turn != self._turn:
            self._enter(turn)
        self._low, self._high = min(self._low, float(error.min())), max(self._high, float(error.max()))
        self._first, self._last = min(self._first, float(theta_m.min())), max(self._last, float(theta_m.max()))

    def _enter(self, turn: int) -> None:
        """A turn was left for `turn`: it is judged, and forgotten."""
        way = 0 if self._turn is None else (1 if turn > self._turn else -1)
        if way and way == self._entered and self._run_up >= RUN_UP:
            self.peak_to_peak = (self._high - self._low) * ARCSEC
        self._run_up = self._last - self._first if way else 0.0
        self._entered, self._turn = way, turn
        self._low, self._high = math.inf, -math.inf
        self._first, self._last = math.inf, -math.inf
