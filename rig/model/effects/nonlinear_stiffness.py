"""A spring that is not straight: soft near zero torque, harder the further it is wound."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter

EXPONENTIAL, KNEE, CUBIC, BELOW = 0.0, 1.0, 2.0, 3.0  # of the first shape parameter


class NonlinearStiffness(Effect):
    """φ gains c·T_0·sgn T·(1 − exp(−|T|/T_0)), or c·sgn T·min(|T|, T_0): extra compliance c below about T_0

    The first is a soft wind-up zone that ends gradually, the second the makers' line of pieces with a knee at T_0
    [harmonicdrive]. The third is a spring T = K·φ + k_3·φ³: φ loses c·(T − T_0·u), u + u³ = T/T_0, where
    k_3 = c·K⁴/T_0² as long as the cubic part is small, and c = 1/K throughout      [tuttle1992]

    Of the fourth the soft zone ends as it began: φ gains c·T·exp(−(T/T_0)²), and beyond a few T_0 nothing.

    The baseline's K is told near zero torque, of whatever laws there are: the makers' K_1, the k_1 of a cubic spring.
    """

    name: ClassVar[str] = "nonlinear_stiffness"
    in_short: ClassVar[str] = "soft wind-up, cubic or piecewise K1/K2/K3"
    glosses: ClassVar[Mapping[str, str]] = {
        "extra_compliance": "c, by how much the spring gives more below about T_0",
        "T_0": "torque about which the spring gets stiffer",
        "k_3": "cubic part of the spring T = K·φ + k_3·φ³",
    }
    source: ClassVar[str] = "harmonicdrive"
    in_the_spring: ClassVar[bool] = True
    backbone: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("kind", "T_0")
    loose: ClassVar[tuple[bool, ...]] = (False, True)
    TORQUES: Final = (1.5, 3.0, 6.0, 12.0, 25.0, 50.0)  # N·m
    STIFFER: Final = 0.5  # of 1/K: c may be less than nothing where several of them make up a curve
    CUBIC_AT: Final = (0.3, 1.0, 3.0)  # of the largest torque: where the cubic part is as large as the other; T³ beyond

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Knees within the torque reached; the gradual law also beyond."""
        gradual = [(EXPONENTIAL, t) for t in self.TORQUES if t < 2.0 * reach.torque]
        knees = [(KNEE, t) for t in self.TORQUES if t < 0.8 * reach.torque]
        cubic = [(CUBIC, share * reach.torque) for share in self.CUBIC_AT if reach.torque > 0]
        below = [(BELOW, t) for t in self.TORQUES if t < 0.8 * reach.torque]
        return (*gradual, *knees, *cubic, *below)

    def beyond(self, shape: Shape, reach: Reach) -> bool:
        """A knee that the fit pushed to next to no torque: that is a gap, and no spring's."""
        return shape[0] != CUBIC and shape[1] < 1.1 * self.bounds(reach)[1][0]

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        kind, T_0 = shape
        if kind == CUBIC:
            return {Port.WIND_UP: -(signals.torque - T_0 * _cubic(signals.torque / T_0))[:, None]}
        if kind == BELOW:
            return {Port.WIND_UP: (signals.torque * np.exp(-((signals.torque / T_0) ** 2)))[:, None]}
        size = np.abs(signals.torque)
        more = np.minimum(size, T_0) if kind == KNEE else T_0 * -np.expm1(-size / T_0)
        return {Port.WIND_UP: (np.sign(signals.torque) * more)[:, None]}

    def gives(self, torque: Array, shape: Shape) -> Array:
        """dφ/dT of its column."""
        kind, T_0 = shape
        x = np.abs(torque) / T_0
        if kind == CUBIC:
            slope = 1.0 / (1.0 + 3.0 * _cubic(x) ** 2) - 1.0
        elif kind == BELOW:
            slope = (1.0 - 2.0 * x**2) * np.exp(-(x**2))
        else:
            slope = (x < 1.0).astype(float) if kind == KNEE else np.exp(-x)
        return np.asarray(slope)[:, None]

    def drags(self, shape: Shape) -> float:
        """A curve in the whole torque."""
        return 1.0

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Its size, the extra compliance, and where it ends; k_3 of a cubic spring."""
        if fit.shape[0] == CUBIC:
            return (self._k_3(fit),)
        by_c, by_t = np.zeros(fit.covariance.shape[0]), np.zeros(fit.covariance.shape[0])
        by_c[0], by_t[-1] = 1.0, 1.0
        return (
            parameter("extra_compliance", fit.coefficients[0], fit.half_width(by_c), "rad/(N·m)"),
            parameter("T_0", fit.shape[1], fit.half_width(by_t), "N·m"),
        )

    def plausible(self, fit: Fit) -> bool:
        """A spring stays a spring, and none is twice as stiff near zero as under load."""
        if fit.shape[0] == CUBIC:
            return True
        return bool(fit.known.K * fit.coefficients[0] > -self.STIFFER)

    def _k_3(self, fit: Fit) -> Parameter:
        """[N·m/rad³]; c and T_0 alone have no meaning where the cubic part is small."""
        c, T_0, fourth = fit.coefficients[0], fit.shape[1], fit.known.K**4
        gradient = np.zeros(fit.covariance.shape[0])
        gradient[0], gradient[-1] = fourth / T_0**2, -2.0 * c * fourth / T_0**3
        return parameter("k_3", c * fourth / T_0**2, fit.half_width(gradient), "N·m/rad³")


def _cubic(x: Array) -> Array:
    """u of u + u³ = x, (n,)."""
    return np.asarray(2 / np.sqrt(3) * np.sinh(np.arcsinh(1.5 * np.sqrt(3) * x) / 3))
