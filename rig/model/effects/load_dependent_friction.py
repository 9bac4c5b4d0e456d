"""Friction that grows with the torque that goes through the mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class LoadDependentFriction(Effect):
    """τ_f gains μ_L·|T|/N·sgn ω_m, so that the load-only efficiency is 1/(1 + μ_L) when driving."""

    name: ClassVar[str] = "load_dependent_friction"
    in_short: ClassVar[str] = "friction grows with transmitted torque"
    source: ClassVar[str] = "tuttle1992"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """None: one law."""
        return ((),)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        return {Port.MOTOR_TORQUE: (np.abs(signals.torque) / signals.ratio * signals.way)[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """μ_L."""
        return (parameter("mu_L", fit.coefficients[0], fit.half_width(np.ones(1)), "1"),)

    def plausible(self, fit: Fit) -> bool:
        """Losses grow."""
        return bool(fit.coefficients[0] > 0)
