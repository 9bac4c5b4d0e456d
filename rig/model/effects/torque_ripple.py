"""Torque ripple of the motor in proportion to its current."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.motor_orders import MOTOR_ORDERS


class TorqueRipple(Effect):
    """The motor gives τ_m·(1 − r·cos(k·θ_m + φ)): what is missing resists it

    Cogging is there without current; where the torque hardly changes over the runs the two cannot be told apart.
    """

    name: ClassVar[str] = "torque_ripple"
    in_short: ClassVar[str] = "motor torque ripple in proportion to current"
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Those of a servo motor."""
        return tuple((float(k),) for k in MOTOR_ORDERS)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """τ_m times cosine and sine."""
        x, kept = shape[0] * signals.theta_m, signals.kept(shape[0], signals.omega_m) * signals.tau_m
        return {Port.MOTOR_TORQUE: np.stack([kept * np.cos(x), kept * np.sin(x)], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Relative amplitude and phase."""
        return harmonic(fit, f"order_{fit.shape[0]:g}", "1")
