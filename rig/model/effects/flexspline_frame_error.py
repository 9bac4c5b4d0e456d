"""Kinematic error that rides on the flexspline, or on whatever turns with the output."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.waves import wave


class FlexsplineFrameError(Effect):
    """θ̃_p gains C·cos(k·(θ_m + σ·θ_l) + φ): order k·(1 + σ/N), 2.04 beside 2      [jia2021]

    σ = +1 when the flexspline is the output and turns against the wave generator, −1 when the circular spline is. Where
    the cup is tilted, C changes along the output's turn, and the order has neighbours at k·(θ_m + σ·θ_l) ± θ_l.
    """

    name: ClassVar[str] = "flexspline_frame_error"
    in_short: ClassVar[str] = "orders that ride on the flexspline (2.04, 4.08 …)"
    glosses: ClassVar[Mapping[str, str]] = waved(
        "order_{n}", "the kinematic error that rides on the flexspline, {n} times a motor turn", "{n}·θ_m"
    ) | waved("beside_{n}", "what the tilt of the cup makes beside that order, {n} times a motor turn", "{n}·θ_m")
    source: ClassVar[str] = "jia2021"
    shape_names: ClassVar[tuple[str, ...]] = ("k", "sigma", "tilt")
    loose: ClassVar[tuple[bool, ...]] = (False, False, False)
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType({"tilt": (0.0,)})
    LEAST: Final = 0.07  # output turns, over which 2.04 and 2 come apart by 0.9 rad: the paper's slow run has 0.16
    ORDERS: Final = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0)  # sharp lobes have many

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Fewer than some output turns cannot tell 2.04 from 2."""
        if reach.load_turns < self.LEAST:
            return ()
        tilted = ((2.0, sigma, 1.0) for sigma in (1.0, -1.0) if reach.load_turns >= 1)
        return (*((k, sigma, 0.0) for sigma in (1.0, -1.0) for k in self.ORDERS), *tilted)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine, with their lever; of a cup that is tilted those of the neighbours as well."""
        waves = [wave(_angle(signals, shape, beside)) for beside in _neighbours(shape)]
        slopes = [_order(shape, signals.ratio, beside) for beside in _neighbours(shape)]
        levers = [w[:, ::-1] * (-slope, slope) for w, slope in zip(waves, slopes, strict=True)]
        return {Port.KINEMATIC_ERROR: np.hstack(waves), Port.LEVER: np.hstack(levers)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase of the order, and of its neighbours."""
        orders = [_order(fit.shape, fit.ratio, beside) for beside in _neighbours(fit.shape)]
        names = [f"{'beside' if i else 'order'}_{order:.4g}" for i, order in enumerate(orders)]
        return tuple(p for i, name in enumerate(names) for p in harmonic(fit, name, "rad", first=2 * i))

    def plausible(self, fit: Fit) -> bool:
        """C changes by no more than itself."""
        sizes = np.hypot(fit.coefficients[0::2], fit.coefficients[1::2])
        return bool(sizes[1:].sum() <= sizes[0])


def _neighbours(shape: Shape) -> tuple[float, ...]:
    """Multiples of θ_l beside the order's own angle, that one first."""
    return (0.0, -1.0, 1.0) if shape[2] else (0.0,)


def _angle(signals: Signals, shape: Shape, beside: float) -> Array:
    k, sigma, _ = shape
    return k * (signals.theta_m + sigma * signals.theta_l) + beside * signals.theta_l


def _order(shape: Shape, ratio: float, beside: float) -> float:
    """Of the motor's angle, as long as the gear does not wind up."""
    k, sigma, _ = shape
    return k * (1.0 + sigma / ratio) + beside / ratio
