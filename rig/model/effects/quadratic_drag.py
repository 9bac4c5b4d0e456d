"""Drag that grows faster than speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class QuadraticDrag(Effect):
    """τ_f gains D·|ω_m/ω_r|^p·sgn ω_m, p about 2, ω_r = 10 rad/s so that D is a torque      [wolf2018]"""

    name: ClassVar[str] = "quadratic_drag"
    in_short: ClassVar[str] = "drag with the square of speed"
    source: ClassVar[str] = "wolf2018"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("exponent",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    EXPONENTS: Final = (1.6, 2.0, 2.6)
    AT: Final = 10.0  # rad/s

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Around 2. Creep alone has no drag to speak of."""
        return tuple((p,) for p in self.EXPONENTS) if reach.fastest > 2.0 * reach.slowest else ()

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Below 1.3 it is viscous, above 3.5 nothing known."""
        return ((1.3, 3.5),)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        drag = np.sign(signals.omega_m) * np.abs(signals.omega_m / self.AT) ** shape[0]
        return {Port.MOTOR_TORQUE: drag[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """D at 10 rad/s and the exponent."""
        drag, exponent = np.eye(2)[:, : fit.covariance.shape[0]]
        return (
            parameter("drag_at_10_rad_s", fit.coefficients[0], fit.half_width(drag), "N·m"),
            parameter("exponent", fit.shape[0], fit.half_width(exponent), "1"),
        )

    def plausible(self, fit: Fit) -> bool:
        """It brakes."""
        return bool(fit.coefficients[0] > 0)
