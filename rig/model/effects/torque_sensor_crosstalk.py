"""The torque sensor feels bending: once or twice per output turn in its reading alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.waves import wave


class TorqueSensorCrosstalk(Effect):
    """The shaft torque reads c·cos(k·θ_l + φ) too much, k = 1 or 2: neither the angles nor the motor know of it"""

    name: ClassVar[str] = "torque_sensor_crosstalk"
    in_short: ClassVar[str] = "once or twice per output turn in the torque sensor alone"
    source: ClassVar[str] = "taghirad1999"
    LARGEST: Final = 3e-4  # rad times K: 2 N·m in the paper's gear, whose sensor reaches some 100 N·m
    needs: ClassVar[frozenset[str]] = frozenset({"tau_l"})
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Less than a sixth of an output turn looks like a trend."""
        return ((1.0,), (2.0,)) if reach.load_turns > 1 / 6 else ()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the load angle."""
        x = shape[0] * signals.theta_l
        return {Port.READS_TAU_L: wave(x)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase."""
        return harmonic(fit, f"order_{fit.shape[0]:g}", "N·m")

    def plausible(self, fit: Fit) -> bool:
        """No larger than what winds the gear up by LARGEST: sensors have tenths of a per cent of crosstalk, and what
        is much larger and turns with the output is its weight."""
        return bool(np.hypot(*fit.coefficients[:2]) < self.LARGEST * fit.known.K)
