"""Kinematic error that rides on the flexspline, or on whatever turns with the output."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.waves import wave


class FlexsplineFrameError(Effect):
    """θ̃_p gains C·cos(k·(θ_m + σ·θ_l) + φ): order k·(1 + σ/N), 2.04 beside 2      [jia2021]

    σ = +1 when the flexspline is the output and turns against the wave generator, −1 when the circular spline is.
    """

    name: ClassVar[str] = "flexspline_frame_error"
    in_short: ClassVar[str] = "orders that ride on the flexspline (2.04, 4.08 …)"
    glosses: ClassVar[Mapping[str, str]] = waved(
        "order_{n}", "the kinematic error that rides on the flexspline, {n} times a motor turn", "{n}·θ_m"
    )
    source: ClassVar[str] = "jia2021"
    shape_names: ClassVar[tuple[str, ...]] = ("k", "sigma")
    loose: ClassVar[tuple[bool, ...]] = (False, False)
    LEAST: Final = 0.15  # output turns, over which 2.04 and 2 come apart by 1.9 rad: the paper's slow run has 0.16
    ORDERS: Final = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0)  # sharp lobes have many

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Fewer than some output turns cannot tell 2.04 from 2."""
        if reach.load_turns < self.LEAST:
            return ()
        return tuple((k, sigma) for sigma in (1.0, -1.0) for k in self.ORDERS)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine, with their lever."""
        k, sigma = shape
        x = k * (signals.theta_m + sigma * signals.theta_l)
        slope = k * (1.0 + sigma / signals.ratio)
        waves = wave(x)
        return {Port.KINEMATIC_ERROR: waves, Port.LEVER: waves[:, ::-1] * (-slope, slope)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase of the order."""
        order = fit.shape[0] * (1.0 + fit.shape[1] / fit.ratio)
        return harmonic(fit, f"order_{order:.4g}", "rad")
