"""An inertia between the gear and the load, on a spring of its own: before the torque sensor or after it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from rig.model.effect import Port, Signals
from rig.model.second_mode.rates import following, rate
from rig.model.second_mode.shaken import shaken
from rig.model.second_mode.swung import swung

Array = npt.NDArray[np.float64]


def hub(s: Signals) -> Mapping[Port, Array]:
    """Two columns, for J_2 and for J_2/k: the gear carries J_2·(ω̇_l + T̈/k) more than the sensor reads, which is a
    spring of k. It winds up under that as 1/(K + B_sp·d/dt): at 80 Hz its damper takes half as much as its spring."""

    def carried(whole: Signals) -> tuple[Array, ...]:
        both = (shaken(whole, x) for x in (whole.alpha_l, rate(whole.torque_rate, whole.dt)))
        return tuple(made for x in both for made in (x, following(x, s.gear.B_sp / s.gear.K, whole.dt)))

    by_load, wound_load, by_spring, wound_spring = s.states(carried)
    return {
        Port.WIND_UP: np.stack([wound_load, wound_spring], 1) / s.gear.K,
        Port.MOTOR_TORQUE: np.stack([by_load, by_spring], 1) * s.lever[:, None],
    }


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

    behind, jerk = s.states(swinging, omega, zeta)
    twist, resists = np.zeros((jerk.size, 3)), np.zeros((jerk.size, 3))
    twist[:, 0], twist[:, 1], resists[:, 2] = behind, -s.alpha_l, jerk
    return {Port.WIND_UP: twist, Port.LOAD_TORQUE: resists}
