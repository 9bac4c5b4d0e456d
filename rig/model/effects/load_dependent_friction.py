"""Friction that grows with the torque that goes through the mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class LoadDependentFriction(Effect):
    """τ_f gains μ_L·|T|/N·sgn ω_m, so that the load-only efficiency is 1/(1 + μ_L) when driving

    Teeth that slide otherwise when the load drives have another μ_L then: one for either flow of power.
    """

    name: ClassVar[str] = "load_dependent_friction"
    in_short: ClassVar[str] = "friction grows with transmitted torque"
    source: ClassVar[str] = "tuttle1992"
    shape_names: ClassVar[tuple[str, ...]] = ("by_flow",)
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One μ_L, or one for either flow of power."""
        return ((0.0,), (1.0,))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, or two: motor driving, load driving."""
        loss = np.abs(signals.torque) / signals.ratio * signals.way
        if not shape[0]:
            return {Port.MOTOR_TORQUE: loss[:, None]}
        driving = signals.torque * signals.way > 0
        return {Port.MOTOR_TORQUE: np.stack([loss * driving, loss * ~driving], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """μ_L, one or two."""
        names = ("mu_L_driving", "mu_L_driven") if fit.shape[0] else ("mu_L",)
        unit = np.eye(fit.covariance.shape[0])
        return tuple(parameter(name, fit.coefficients[i], fit.half_width(unit[i]), "1") for i, name in enumerate(names))

    def plausible(self, fit: Fit) -> bool:
        """Losses grow."""
        return bool(np.sum(fit.coefficients) > 0)
