"""What a run shows so far: peak to peak over the last whole motor turn, and how well the motor follows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rig.core.units import ARCSEC, DEG
from rig.live.calm import Calm
from rig.live.view.turns import Turns
from rig.model.transmission_error import transmission_error

Rows = np.ndarray[Any, Any]


class SoFar:
    """Fed with every row of the ring, in order. Figures are None before they mean anything."""

    def __init__(self, ratio: float) -> None:
        self.ratio = ratio
        self.peak_to_peak: float | None = None  # arcsec, of the means of 1° of θ̃ = θ_m/N − θ_l over the last calm turn
        self.zero: float | None = None  # rad, θ̃ of the first row
        self.newest = 0.0  # s, t of the last row
        self._calm, self._turns = Calm(), Turns()
        self._squares, self._n = 0.0, 0

    @property
    def following(self) -> float | None:
        """Root mean square of reference minus motor angle [deg], over the rows that have a reference."""
        return math.sqrt(self._squares / self._n) / DEG if self._n else None

    def add(self, rows: Rows) -> Rows:
        """The next rows, shape (n,); True for those whose θ̃ tells of the gear, shape (n,)."""
        told = self._calm.of(rows["t"], rows["flags"])
        if not len(rows):
            return told
        error = transmission_error(rows["theta_m"], rows["theta_l"], self.ratio)
        if self.zero is None:
            self.zero = float(error[0])
        self.newest = float(rows["t"][-1])
        behind = rows["theta_ref"] - rows["theta_m"]
        behind = behind[~np.isnan(behind)]
        self._squares += float(behind @ behind)
        self._n += len(behind)
        told &= np.isfinite(error)
        for turn in self._turns.add(rows["theta_m"][told], error[told]):
            if not math.isnan(turn.peak_to_peak):
                self.peak_to_peak = turn.peak_to_peak / ARCSEC
        return told
