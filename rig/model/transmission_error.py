"""Equation 1: what the load lacks of the motor's angle over the gear ratio."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def transmission_error(theta_m: Array, theta_l: Array, ratio: float) -> Array:
    """θ̃ = θ_m/N − θ_l      [ghorbel2001, Eq. 1]

    `theta_m`, `theta_l`: rad, any one shape; gives rad at the output, positive when the load lags the motor.
    """
    return np.asarray(theta_m / ratio - theta_l)
