"""The motor encoder's disc is off its axis: once per motor turn in the reading alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.waves import powers


class MotorEncoderEccentricity(Effect):
    """The motor angle reads Σ e_k·cos(k·θ_m + φ_k) too much, k = 1 to 5, the first the largest

    A disc off its axis reads an arc tangent of the angle, whose next orders are smaller. In angle the
    kinematic error's same orders take it up in every run; only J_m·ω̇_m of fast runs tells it from a real one.
    """

    name: ClassVar[str] = "motor_encoder_eccentricity"
    in_short: ClassVar[str] = "once per motor turn, never amplified by the dynamics"
    glosses: ClassVar[Mapping[str, str]] = waved("eccentricity", "the motor encoder's error, once a motor turn", "θ_m")
    source: ClassVar[str] = "ghorbel2001"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    ORDERS: Final = 5

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """None: once per turn."""
        return ((),)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the motor angle and its multiples."""
        return {Port.READS_THETA_M: powers(signals.theta_m, self.ORDERS)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase of the first order."""
        return harmonic(fit, "eccentricity", "rad")

    def plausible(self, fit: Fit) -> bool:
        """An arc tangent's first order is larger than the others together."""
        sizes = np.hypot(fit.coefficients[::2], fit.coefficients[1::2])
        return bool(sizes[0] > sizes[1:].sum())
