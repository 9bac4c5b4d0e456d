"""The kinematic error of a slow run by direction, with the torque the gear carried: friction of the load adds to a
weight one way and takes off from it the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.motion.strokes import Stroke
from rig.analysis.orders.revolutions import ROWS_PER_TERM, analyse_stroke
from rig.model.fourier import PAPER_ORDERS


@dataclass(frozen=True)
class Way:
    """One direction: mean shaft torque N·m, rms of θ̃ over a turn arcsec, 1 σ of it, revolutions."""

    direction: int
    torque: float
    size: float
    u: float
    revolutions: int


def ways_of(motion: Motion, strokes: list[Stroke], tau_l: Array | None) -> tuple[Way, ...]:
    """Both directions of `strokes`, those with two revolutions at least; none without a whole shaft torque."""
    if tau_l is None or not np.isfinite(tau_l).all():
        return ()
    terms = min(PAPER_ORDERS, min(int(np.min(np.diff(s.edges))) for s in strokes) // ROWS_PER_TERM)
    sides = [[s for s in strokes if s.direction == d] for d in (1, -1)]
    return tuple(_way(motion, side, tau_l, terms) for side in sides if sum(s.revolutions for s in side) > 1)


def _way(motion: Motion, side: list[Stroke], tau_l: Array, terms: int) -> Way:
    found = [analyse_stroke(motion, s, terms) for s in side]
    c = np.concatenate([np.hstack((f.cosine, f.sine)) for f in found])
    mean, n = c.mean(axis=0), c.shape[0]
    size = float(np.sqrt(0.5 * np.sum(mean**2)))
    u = float(np.sqrt(np.sum((0.5 * mean / max(size, 1e-300)) ** 2 * c.var(axis=0, ddof=1) / n)))
    torque = float(np.mean(np.concatenate([tau_l[s.start : s.stop] for s in side])))
    return Way(side[0].direction, torque, size, u, n)
