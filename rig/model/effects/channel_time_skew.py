"""One channel is read later than the others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class ChannelTimeSkew(Effect):
    """The load angle read at t belongs to t − δ: it reads θ_l(t − δ) − θ_l(t) too much.

    From the reading θ: −[θ(t + δ) − θ(t)] = −δ·(ω + δ·α/2 + δ²·j/6) with speed, acceleration and jerk as read.
    Other channels late by δ are this one early by δ, but for the torque, which is slow.
    """

    name: ClassVar[str] = "channel_time_skew"
    in_short: ClassVar[str] = "one channel read later than another"
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("about",)  # s, the skew the expansion is made at
    loose: ClassVar[tuple[bool, ...]] = (False,)
    LARGEST: Final = 7e-3  # s, a quarter of a period at 36 Hz
    STEPS: Final = (0.0, 1e-3, -1e-3, 4e-3, -4e-3)  # s; the refit takes the coefficient as next expansion point

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Expansion points."""
        return tuple((step,) for step in self.STEPS)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column; its coefficient is δ."""
        delta = shape[0]
        late = signals.omega_l + delta / 2 * signals.alpha_l + delta**2 / 6 * signals.jerk_l
        return {Port.READS_THETA_L: -late[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """δ of the load angle."""
        along = np.zeros(fit.covariance.shape[0])
        along[0] = 1.0
        return (parameter("skew_theta_l", fit.coefficients[0], fit.half_width(along), "s"),)

    def expands(self, shape: Shape) -> bool:
        """About the skew itself."""
        return True

    def about(self, shape: Shape, coefficients: Array) -> Shape:
        """The skew as found, within a quarter of a period of what the low-pass lets through."""
        return (float(np.clip(coefficients[0], -self.LARGEST, self.LARGEST)),)
