"""Stiffness that changes over a turn of the wave generator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic


class AngleDependentStiffness(Effect):
    """1/K gains κ/K·cos(k·θ_m + φ), k = 1, 2, 4: φ gains T/K·κ·cos …

    The reaction ½·φ²·dK/dθ_m on the motor is left out: 0.01 N·m with κ = 5 % at 40 N·m.
    """

    name: ClassVar[str] = "angle_dependent_stiffness"
    in_short: ClassVar[str] = "stiffness modulated by angle"
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    loose: ClassVar[tuple[bool, ...]] = (False,)
    ORDERS: Final = (1.0, 2.0, 3.0, 4.0, 6.0)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Low orders of the wave generator."""
        return tuple((k,) for k in self.ORDERS)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """T times cosine and sine."""
        x = shape[0] * signals.theta_m
        return {Port.WIND_UP: np.stack([np.cos(x), np.sin(x)], 1) * signals.torque[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Relative amplitude of the compliance, and phase."""
        return harmonic(fit, f"kappa_order_{fit.shape[0]:g}", "1", scale=fit.known.K)
