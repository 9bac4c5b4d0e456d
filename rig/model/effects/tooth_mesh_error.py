"""Kinematic error at the order of the tooth count."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.waves import wave


class ToothMeshError(Effect):
    """θ̃_p gains C·cos(z·θ_m + φ), z = 2N teeth of the flexspline, 2N + 2 of the circular spline, or twice as many

    A wave generator that is not true presses harder once or twice a turn: orders beside those by one and two. Where
    every second tooth is another one there are half as many.
    """

    name: ClassVar[str] = "tooth_mesh_error"
    in_short: ClassVar[str] = "orders of the tooth count"
    glosses: ClassVar[Mapping[str, str]] = waved(
        "order_{n}", "the kinematic error of the teeth, {n} times a motor turn", "{n}·θ_m"
    )
    source: ClassVar[str] = "tuttle1992"
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    loose: ClassVar[tuple[bool, ...]] = (False,)
    MULTIPLES: Final = (1, 2)
    BESIDE: Final = 2

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Orders the slowest run samples at least three times a period."""
        teeth = [2 * reach.ratio + beside for beside in range(-self.BESIDE, 3 + self.BESIDE)]
        highest = reach.rate / 3.0 / (reach.slowest / (2.0 * np.pi))
        halves = [z / 2 for z in (2 * reach.ratio, 2 * reach.ratio + 2)]
        orders = [*halves, *(m * z for m in self.MULTIPLES for z in teeth)]
        return tuple((order,) for order in orders if order < highest)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine, with their lever."""
        k = shape[0]
        x, kept = k * signals.theta_m, signals.kept(k, signals.omega_m)
        waves = wave(x, kept)
        return {Port.KINEMATIC_ERROR: waves, Port.LEVER: waves[:, ::-1] * (-k, k)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase."""
        return harmonic(fit, f"order_{fit.shape[0]:g}", "rad")
