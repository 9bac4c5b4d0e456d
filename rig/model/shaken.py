"""What shakes a second mode: only where the motor turns fast enough to reach it with the orders of the gear."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from rig.model.effect import Signals

Array = npt.NDArray[np.float64]

EXCITED: Final = 3.0  # rad/s of the motor: order 15 of a gear's error then comes to 7 Hz


def shaken(s: Signals, x: Array) -> Array:
    """What a resonance makes, `x` (n,), where the motor turns fast enough, 0 elsewhere: in slow runs there is nothing
    but noise at such frequencies, which a sharp one would only amplify, and be told by."""
    return np.where(np.abs(s.omega_m) > EXCITED, np.nan_to_num(x), 0.0)
