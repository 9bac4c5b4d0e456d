"""Rates of what has been low-passed already, and what follows it."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from rig.model.memory import follower

Array = npt.NDArray[np.float64]

AROUND: Final = 3  # rows
SIXTH: Final = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60  # central difference of the sixth order


def rate(x: Array, dt: float) -> Array:
    """dx/dt (n,), by the three rows on each side: a difference of neighbours lacks a sixth at a sixth of the rate."""
    out = np.gradient(x, dt)
    if x.size > 2 * AROUND:
        out[AROUND:-AROUND] = np.correlate(x, SIXTH, "valid") / dt
    return out


def following(x: Array, tau: float, dt: float) -> Array:
    """x (n,) through 1/(1 + τs), τ in s, x linear between rows dt s apart, exact; starts in balance with x[0]."""
    keep = float(np.exp(-dt / tau)) if tau > 0 else 0.0
    slope = tau / dt * (1.0 - keep)
    now, before = 1.0 - slope, slope - keep
    return np.asarray(follower(np.ascontiguousarray(x), now, before, keep, float(x[0]) * slope if x.size else 0.0))
