"""The torque sensor feels bending: once or twice per output turn in its reading alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic


class TorqueSensorCrosstalk(Effect):
    """The shaft torque reads c·cos(k·θ_l + φ) too much, k = 1 or 2: neither the angles nor the motor know of it"""

    name: ClassVar[str] = "torque_sensor_crosstalk"
    in_short: ClassVar[str] = "once or twice per output turn in the torque sensor alone"
    source: ClassVar[str] = "taghirad1999"
    needs: ClassVar[frozenset[str]] = frozenset({"tau_l"})
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Less than a sixth of an output turn looks like a trend."""
        return ((1.0,), (2.0,)) if reach.load_turns > 1 / 6 else ()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the load angle."""
        x = shape[0] * signals.theta_l
        return {Port.READS_TAU_L: np.stack([np.cos(x), np.sin(x)], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase."""
        return harmonic(fit, f"order_{fit.shape[0]:g}", "N·m")
