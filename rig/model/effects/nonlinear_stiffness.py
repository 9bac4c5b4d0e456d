"""A spring that is not straight: soft near zero torque, harder the further it is wound."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter

EXPONENTIAL, KNEE = 0.0, 1.0  # of the first shape parameter


class NonlinearStiffness(Effect):
    """φ gains c·T_0·sgn T·(1 − exp(−|T|/T_0)), or c·sgn T·min(|T|, T_0): extra compliance c below about T_0

    The first is a soft wind-up zone that ends gradually (a cubic spring within the torque of a test), the second the
    makers' line of pieces with a knee at T_0      [harmonicdrive]
    """

    name: ClassVar[str] = "nonlinear_stiffness"
    in_short: ClassVar[str] = "soft wind-up, cubic or piecewise K1/K2/K3"
    source: ClassVar[str] = "harmonicdrive"
    shape_names: ClassVar[tuple[str, ...]] = ("kind", "T_0")
    loose: ClassVar[tuple[bool, ...]] = (False, True)
    TORQUES: Final = (1.5, 3.0, 6.0, 12.0, 25.0, 50.0)  # N·m; a cubic spring looks like twice the largest torque

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Knees within the torque reached; the gradual law also beyond."""
        gradual = [(EXPONENTIAL, t) for t in self.TORQUES if t < 2.0 * reach.torque]
        knees = [(KNEE, t) for t in self.TORQUES if t < 0.8 * reach.torque]
        return (*gradual, *knees)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        kind, T_0 = shape
        size = np.abs(signals.torque)
        more = np.minimum(size, T_0) if kind == KNEE else T_0 * -np.expm1(-size / T_0)
        return {Port.WIND_UP: (np.sign(signals.torque) * more)[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Stiffness near zero and at high torque, and where it changes."""
        c, high = fit.coefficients[0], fit.known.K
        near = 1.0 / (1.0 / high + c)
        by_c, by_t = np.zeros(fit.covariance.shape[0]), np.zeros(fit.covariance.shape[0])
        by_c[0], by_t[-1] = -(near**2), 1.0
        return (
            parameter("K_near_zero", near, fit.half_width(by_c), "N·m/rad"),
            parameter("T_0", fit.shape[1], fit.half_width(by_t), "N·m"),
        )

    def plausible(self, fit: Fit) -> bool:
        """A spring stays a spring: stiffness near zero is positive."""
        return bool(1.0 / fit.known.K + fit.coefficients[0] > 0)
