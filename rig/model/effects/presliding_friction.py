"""Friction with memory around reversals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.memory import presliding


class PreslidingFriction(Effect):
    """Instead of jumping, τ_c·sgn ω_m builds up with the way: τ_c·z, dz/dθ_m = (1 − z·sgn ω_m)/x_0      [dahl1968]

    The column is z − sgn ω_m, what the baseline's constant friction has too much after each reversal.
    """

    name: ClassVar[str] = "presliding_friction"
    in_short: ClassVar[str] = "friction with memory around reversals"
    source: ClassVar[str] = "dahl1968"
    shape_names: ClassVar[tuple[str, ...]] = ("x_0",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    WAYS: Final = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0)  # rad of the motor; less than a sample of the slow run at first

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Ways longer than the motor goes between two samples of the slowest run."""
        return tuple((x,) for x in self.WAYS if x > 0.5 * reach.slowest / reach.rate)

    def moved_by_noise(self) -> bool:
        """The friction of a motor that rests builds up with the way its encoder seems to go."""
        return True

    def has_state(self) -> bool:
        """It builds up."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        way = np.sign(signals.omega_m)
        return {Port.MOTOR_TORQUE: (presliding(signals.theta_m, shape[0]) - way)[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """The friction that builds up, and over which way."""
        torque, way = np.eye(2)[:, : fit.covariance.shape[0]]
        return (
            parameter("tau_presliding", fit.coefficients[0], fit.half_width(torque), "N·m"),
            parameter("x_0", fit.shape[0], fit.half_width(way), "rad"),
        )

    def plausible(self, fit: Fit) -> bool:
        """Friction opposes."""
        return bool(fit.coefficients[0] > 0)
