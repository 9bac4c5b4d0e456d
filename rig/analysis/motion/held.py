"""Did an output that is said to be locked stay where it was?"""

from __future__ import annotations

import numpy as np

from rig.core.rows import Array

HELD = 3.0  # ° of the output in a lock test: a soft housing gives a tenth of that


def not_held(theta_l: Array | None) -> str:
    """Why a run with a locked output is none, of its load angle [rad], shape (n,) or None; "" where it held."""
    there = np.empty(0) if theta_l is None else theta_l[np.isfinite(theta_l)]
    went = float(np.rad2deg(np.ptp(there))) if there.size else 0.0
    return f"it says its output is locked, and its load angle goes {went:.3g}°" if went > HELD else ""
