"""What inertia adds to the kinematic error at a given speed, by bending the gear."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.result import Array


def added_share(orders: Array, omega_m: float, K: float, J_l: float) -> Array:
    """(nΩ/ω_h)² with ω_h = √(K/J_l): share of each amplitude that inertia adds at motor speed Ω rad/s.

    Follows from Eq. 7 with the motor held to its reference: θ̃_n = θ̃_p,n / (1 − r²), so θ̃_p,n = θ̃_n·(1 − r²). With a
    free motor J_l is in series with N²·J_m and the share a fifth smaller on this rig; a position loop lies between.
    Never above 1.      [ghorbel2001, Eq. 7]
    """
    return np.asarray(np.minimum((orders * omega_m) ** 2 * (J_l / K), 1.0))
