"""Friction that falls as the drive warms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class ThermalFrictionDrift(Effect):
    """τ_f gains (τ_1·sgn ω_m + B_1·ω_m)·exp(−t/t_w), t since the campaign began      [wolf2018]

    What is gone at the end of the warm-up is here, what stays is in the baseline. Between runs the clock goes on.
    """

    name: ClassVar[str] = "thermal_friction_drift"
    in_short: ClassVar[str] = "friction falls as the drive warms"
    source: ClassVar[str] = "wolf2018"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("t_w",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    TIMES: Final = (120.0, 300.0, 700.0, 1600.0, 4000.0)  # s; a gear box of this size warms in 5 to 40 min

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Time constants the campaign is long enough for."""
        return tuple((t,) for t in self.TIMES if t < 2 * reach.duration)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Constant and viscous part."""
        cold = np.exp(-signals.t / shape[0])
        return {Port.MOTOR_TORQUE: np.stack([signals.way * cold, signals.omega_m * cold], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """What the warm-up takes away, and its time constant."""
        constant, viscous, time = np.eye(3)[:, : fit.covariance.shape[0]]
        return (
            parameter("tau_cold", fit.coefficients[0], fit.half_width(constant), "N·m"),
            parameter("B_cold", fit.coefficients[1], fit.half_width(viscous), "N·m·s/rad"),
            parameter("t_w", fit.shape[0], fit.half_width(time), "s"),
        )
