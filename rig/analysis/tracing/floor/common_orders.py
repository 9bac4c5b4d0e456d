"""What all turns of the motor have in common, taken off before residuals of one angle are compared.

A fast run has few rows a turn: between two of them a straight line misses the high orders, and what a model lacks there
would count as noise, though every turn repeats it.
"""

from __future__ import annotations

import numpy as np

from rig.analysis.tracing.fit.channels import ORDERS
from rig.core.units import TURN
from rig.model.effect import Array

FINE = 60.0  # rows a turn: a line between two of them misses a quarter of an order 15, of a lower order little


def without_common_orders(theta: Array, e: Array) -> Array:
    """Residual `e` (n,) less the waves of the motor angle `theta` (n,), rad, that fit all of it; unchanged of a run
    with many rows a turn, or too few to tell waves by."""
    step = float(np.median(np.abs(np.diff(theta)))) if theta.size > 1 else 0.0
    if step * FINE < TURN or theta.size < 4 * ORDERS:
        return e
    angle = np.outer(theta, np.arange(1, ORDERS + 1))
    waves = np.hstack([np.cos(angle), np.sin(angle)])
    found, *_ = np.linalg.lstsq(waves, e - e.mean(), rcond=1e-6)
    return np.asarray(e - waves @ found)
