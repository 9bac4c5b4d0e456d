"""What shakes a second mode: orders of the gear where the motor turns fast enough to reach it, and the motor turning
back."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from rig.model.effect import Signals

Array = npt.NDArray[np.float64]

EXCITED: Final = 3.0  # rad/s of the motor: order 15 of a gear's error then comes to 7 Hz
BRISK: Final = 0.3  # rad/s of the motor: it turns back in a moment, where a lock test takes seconds
NEAR: Final = 0.4  # s before and after


def shaken(s: Signals, x: Array) -> Array:
    """What a resonance makes, `x` (n,), where something shakes it, 0 elsewhere: in slow runs there is nothing but noise
    at such frequencies, which a sharp one would only amplify, and be told by."""
    return np.where(s.once("shaken", lambda: _where(s)), np.nan_to_num(x), 0.0)


def _where(s: Signals) -> npt.NDArray[np.bool_]:
    speed = np.abs(s.omega_m)
    brisk = np.flatnonzero(speed > BRISK)
    way = np.sign(s.omega_m[brisk])
    before = brisk[:-1][way[1:] != way[:-1]]
    after = brisk[1:][way[1:] != way[:-1]]
    near, edge = np.zeros(s.t.size + 1), round(NEAR / s.dt)
    soon = after - before < edge  # or it rested between
    np.add.at(near, np.maximum(before[soon] - edge, 0), 1.0)
    np.add.at(near, np.minimum(after[soon] + edge, s.t.size), -1.0)
    return np.asarray((speed > EXCITED) | (np.cumsum(near)[:-1] > 0.5))
