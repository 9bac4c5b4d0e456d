"""A curve over one turn from its orders."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.orders.align import Complex
from rig.analysis.orders.revolutions import GRID


def wave(phasor: Complex, points: int = GRID) -> Array:
    """Re Σ z_n·exp(jnθ) in the middle of `points` equal parts of a turn, orders from 1 on, in the unit of `phasor`."""
    angle = np.multiply.outer((np.arange(points) + 0.5) / points * 2.0 * np.pi, np.arange(1.0, phasor.size + 1))
    return np.asarray(np.cos(angle) @ phasor.real - np.sin(angle) @ phasor.imag)
