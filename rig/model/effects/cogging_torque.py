"""Torque ripple of the motor that is there without current."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.motor_orders import MOTOR_ORDERS
from rig.model.waves import wave


class CoggingTorque(Effect):
    """τ_m loses C·cos(k·θ_m + φ), k a whole number of cycles per motor turn."""

    name: ClassVar[str] = "cogging_torque"
    in_short: ClassVar[str] = "motor torque ripple at rest, fixed orders of the motor"
    glosses: ClassVar[Mapping[str, str]] = waved(
        "order_{n}", "the motor torque lost without current, {n} times a motor turn", "{n}·θ_m"
    )
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    comes_round: ClassVar[bool] = True
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Those of a servo motor."""
        return tuple((float(k),) for k in MOTOR_ORDERS)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine."""
        x, kept = shape[0] * signals.theta_m, signals.kept(shape[0], signals.omega_m)
        return {Port.MOTOR_TORQUE: wave(x, kept)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase."""
        return harmonic(fit, f"order_{fit.shape[0]:g}", "N·m")
