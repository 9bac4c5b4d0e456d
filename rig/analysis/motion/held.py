"""Did an output that is said to be locked stay where it was, and a motor that is said to stand?"""

from __future__ import annotations

import numpy as np

from rig.core.rows import Array
from rig.core.units import TURN

HELD = 3.0  # ° of the output in a lock test: a soft housing gives a tenth of that
STOOD = 0.1  # turns of the motor at a standstill: one that creeps by a hundredth is told so by its check


def not_held(theta_l: Array | None) -> str:
    """Why a run with a locked output is none, of its load angle [rad], shape (n,) or None; "" where it held."""
    there = np.empty(0) if theta_l is None else theta_l[np.isfinite(theta_l)]
    went = float(np.rad2deg(np.ptp(there))) if there.size else 0.0
    return f"it says its output is locked, and its load angle goes {went:.3g}°" if went > HELD else ""


def not_still(theta_m: Array | None) -> str:
    """Why a standstill is none, of its motor angle [rad], shape (n,) or None; "" where it stood."""
    there = np.empty(0) if theta_m is None else theta_m[np.isfinite(theta_m)]
    went = float(np.ptp(there)) / TURN if there.size else 0.0
    return f"it says it is a standstill, and its motor goes {went:.3g} turns" if went > STOOD else ""
