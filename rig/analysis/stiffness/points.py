"""The ramps as points: means over small cells of wind-up, so that where the motor stuck weighs like elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.stiffness.branches import Ramp

CELLS = 150  # over the whole wind-up: a tenth of the zone of the softest line
NEARBY = np.ones(3)  # cells over which the speed is taken: one cell holds two or three counts
LATE = 0.25  # of the whole wind-up: a ramp that began inside the loop is used once it has gone this far


@dataclass(frozen=True)
class Points:
    """Means over the rows of one ramp in one cell; every array (p,)."""

    windup: Array  # rad, less the kinematic error where it is known
    tau: Array  # N·m
    gone: Array  # rad, from the turn the ramp started at
    direction: Array  # +1 or −1
    rate: (
        Array  # rad/s there, in the mean over time: little where the motor stuck, much where it slipped; 0 without time
    )
    error: Array  # rad, the kinematic error that was subtracted; zeros without a reference
    ramp: npt.NDArray[np.int64]  # which ramp

    def pick(self, which: npt.NDArray[np.bool_] | npt.NDArray[np.int64]) -> Points:
        """Those where `which` (p,) is true, or those at the places `which`."""
        return Points(*(getattr(self, name)[which] for name in self.__dataclass_fields__))

    def with_share(self, share: float) -> Points:
        """As if `share` of the kinematic error had been subtracted instead of all of it."""
        return replace(self, windup=self.windup + (1.0 - share) * self.error)

    @property
    def reach(self) -> float:
        """Half of the whole wind-up, rad."""
        return float(np.ptp(self.windup)) / 2


def points_of(ramps: list[Ramp], windup: Array, tau: Array, error: Array, t: Array | None) -> Points:
    """All ramps of a run as points; `windup` and `error` rad, `tau` N·m, `t` s, all (n,)."""
    low, whole = float(windup.min()), float(np.ptp(windup))
    row = np.inf if t is None else float(np.median(np.diff(t)))  # s
    parts = []
    for k, ramp in enumerate(ramps):
        piece = slice(ramp.lo, ramp.hi)
        cell = np.minimum(((windup[piece] - low) / whole * CELLS).astype(np.int64), CELLS - 1)
        rows = np.bincount(cell, minlength=CELLS)
        here = rows > 0
        w, y, e = (np.bincount(cell, x[piece], CELLS)[here] / rows[here] for x in (windup, tau, error))
        gone = np.abs(w - ramp.begin)
        use = np.full(gone.size, True) if ramp.on_loop else gone > LATE * whole
        one = np.ones(gone.size)
        passed = np.convolve(here, NEARBY, "same") * whole / CELLS
        rate = (passed / (np.maximum(np.convolve(rows, NEARBY, "same"), 1.0) * row))[here]
        parts.append(np.stack((w, y, gone, one * ramp.direction, rate, e, one * k))[:, use])
    w, y, gone, direction, rates, e, which = np.concatenate(parts, axis=1) if parts else np.empty((7, 0))
    return Points(w, y, gone, direction, rates, e, which.astype(np.int64))


def rates_differ(points: Points) -> bool:
    """Whether the speeds span a factor of two, so that what grows with them shows."""
    slow, fast = np.percentile(points.rate, (10, 90))
    return bool(fast > 2.0 * slow > 0.0)
