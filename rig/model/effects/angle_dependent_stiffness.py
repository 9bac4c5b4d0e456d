"""Stiffness that changes over a turn of the wave generator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic


class AngleDependentStiffness(Effect):
    """1/K gains κ/K·cos(k·θ_m + φ), k = 1, 2, 4: the wind-up gains T·κ/K·cos …, the motor is resisted by ½·φ²·dK/dθ_m

    That reaction, −½·T²·d(1/K)/dθ_m, is 0.01 N·m with κ = 5 % at 40 N·m. Where the angle at which the stiffness changes
    is not that of the spring's own energy it is absent: the data choose.
    """

    name: ClassVar[str] = "angle_dependent_stiffness"
    in_short: ClassVar[str] = "stiffness modulated by angle"
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order", "reaction")
    loose: ClassVar[tuple[bool, ...]] = (False, False)
    ORDERS: Final = (1.0, 2.0, 3.0, 4.0, 6.0)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Low orders of the wave generator."""
        return tuple((k, reaction) for k in self.ORDERS for reaction in (1.0, 0.0))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """T times cosine and sine, and what they do to the motor."""
        k, reaction = shape
        x, torque = k * signals.theta_m, signals.torque[:, None]
        back = reaction * k / 2 * torque**2
        return {
            Port.WIND_UP: np.stack([np.cos(x), np.sin(x)], 1) * torque,
            Port.MOTOR_TORQUE: np.stack([np.sin(x), -np.cos(x)], 1) * back,
        }

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Relative amplitude of the compliance, and phase."""
        return harmonic(fit, f"kappa_order_{fit.shape[0]:g}", "1", scale=fit.known.K)
