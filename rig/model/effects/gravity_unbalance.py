"""Torque once per output turn: the load's centre of mass is off its axis, and the axis is not upright."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic


class GravityUnbalance(Effect):
    """The load is resisted by m·g·e·cos(θ_l + φ); by a second wave where a cable or a joint pulls twice a turn"""

    name: ClassVar[str] = "gravity_unbalance"
    in_short: ClassVar[str] = "torque once per output turn"
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Less than a sixth of an output turn looks like a trend."""
        return ((1.0,), (2.0,)) if reach.load_turns > 1 / 6 else ()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the load angle."""
        x = shape[0] * signals.theta_l
        return {Port.LOAD_TORQUE: np.stack([np.cos(x), np.sin(x)], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """m·g·e and phase; of a second wave amplitude and phase."""
        return harmonic(fit, "unbalance" if fit.shape[0] == 1.0 else "twice_a_turn", "N·m")
