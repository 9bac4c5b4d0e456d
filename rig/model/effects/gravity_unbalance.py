"""Torque once per output turn: the load's centre of mass is off its axis, and the axis is not upright."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic


class GravityUnbalance(Effect):
    """The load is resisted by m·g·e·cos(θ_l + φ)"""

    name: ClassVar[str] = "gravity_unbalance"
    in_short: ClassVar[str] = "torque once per output turn"
    source: ClassVar[str] = "ghorbel2001"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Less than a sixth of an output turn looks like a trend."""
        return ((),) if reach.load_turns > 1 / 6 else ()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the load angle."""
        return {Port.LOAD_TORQUE: np.stack([np.cos(signals.theta_l), np.sin(signals.theta_l)], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """m·g·e and phase."""
        return harmonic(fit, "unbalance", "N·m")
