"""Which way a motor slides, and where it has slid for so long that what stuck has come loose."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.thresholds import LOOSE, SETTLING, SLOWEST_TURNING
from rig.model.effect import Array, Signals


def direction(omega: Array, dt: float) -> Array:
    """−1 or 1 while it slides, 0 around every reversal and stop; (n,)."""
    sign = np.where(np.abs(omega) > SLOWEST_TURNING, np.sign(omega), 0.0)
    width = max(1, round(LOOSE / dt))
    turns = np.flatnonzero((sign == 0) | (np.diff(sign, prepend=sign[:1]) != 0))
    edges = np.zeros(omega.size + 1)
    np.add.at(edges, np.maximum(turns - width, 0), 1.0)
    np.add.at(edges, np.minimum(turns + width + 1, omega.size), -1.0)
    return np.where(np.cumsum(edges[:-1]) > 0, 0.0, sign)


def settled(piece: Signals) -> npt.NDArray[np.bool_]:
    """Where it has slid, and goes on to slide, for so long that what stuck has come loose; (n,)."""
    width = max(1, round(SETTLING / piece.dt)) - max(1, round(LOOSE / piece.dt))
    stopped, rows = np.concatenate([[0], np.cumsum(piece.way == 0)]), np.arange(piece.t.size)
    before, after = np.maximum(rows - width, 0), np.minimum(rows + width + 1, rows.size)
    return np.asarray(stopped[after] == stopped[before])
