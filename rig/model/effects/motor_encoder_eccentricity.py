"""The motor encoder's disc is off its axis: once per motor turn in the reading alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic


class MotorEncoderEccentricity(Effect):
    """The motor angle reads e·cos(θ_m + φ) too much

    In angle the kinematic error's order 1 takes it up in every run; only J_m·ω̇_m of fast runs tells it from a real one.
    """

    name: ClassVar[str] = "motor_encoder_eccentricity"
    in_short: ClassVar[str] = "once per motor turn, never amplified by the dynamics"
    source: ClassVar[str] = "ghorbel2001"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """None: once per turn."""
        return ((),)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the motor angle."""
        return {Port.READS_THETA_M: np.stack([np.cos(signals.theta_m), np.sin(signals.theta_m)], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase."""
        return harmonic(fit, "eccentricity", "rad")
