"""An inertia between the gear and the load, on a spring of its own: before the torque sensor or after it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.model.effect import Port, Signals
from rig.model.second_mode.shaken import shaken
from rig.model.second_mode.swung import swung

Array = npt.NDArray[np.float64]

AROUND: Final = 3  # rows
SIXTH: Final = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60  # central difference of the sixth order


def hub(s: Signals) -> Mapping[Port, Array]:
    """Two columns, for J_2 and for J_2/k: the gear carries J_2·(ω̇_l + T̈/k) more than the sensor reads, which is a
    spring of k."""
    (bend,) = s.states(lambda whole: (_rate(whole.torque_rate, whole.dt),))
    turned = np.stack([s.alpha_l, bend], 1)
    lever = 1.0 / s.ratio - s.series_slope
    return {Port.WIND_UP: turned / s.gear.K, Port.MOTOR_TORQUE: turned * lever[:, None]}


def _rate(x: Array, dt: float) -> Array:
    """dx/dt (n,), by the three rows on each side: a difference of neighbours lacks a sixth at a sixth of the rate."""
    out = np.gradient(x, dt)
    if x.size > 2 * AROUND:
        out[AROUND:-AROUND] = np.correlate(x, SIXTH, "valid") / dt
    return out


def flange(s: Signals, omega: float, zeta: float) -> Mapping[Port, Array]:
    """Three, where the inertia is behind the sensor and a shaft of k behind that.

    The shaft twists by δ = (T − J_2·(ω̇_l + δ̈))/k, and J_2·δ̈ = (1 − H_p)·T, both inertias swinging against each other:
    beyond T/k, which the gear's own 1/K has, that is (H_p − 1)·T/k − (J_2/k)·ω̇_l. The load follows H_p·T, which is
    T − s²·H_p·T/ω_p². The columns are for 1/k, J_2/k and 1/ω_p².
    """

    def swinging(whole: Signals) -> tuple[Array, ...]:
        torque = np.nan_to_num(whole.torque)
        after, jerk = swung(whole, torque, omega, zeta)
        return shaken(whole, after - torque), shaken(whole, jerk)

    behind, jerk = s.states(swinging)
    twist, resists = np.zeros((jerk.size, 3)), np.zeros((jerk.size, 3))
    twist[:, 0], twist[:, 1], resists[:, 2] = behind, -s.alpha_l, jerk
    return {Port.WIND_UP: twist, Port.LOAD_TORQUE: resists}
