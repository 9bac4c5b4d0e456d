"""A loop in torque against wind-up that does not depend on how fast it is gone round."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.memory import play


class HystereticStiffness(Effect):
    """φ gains Σ c_i·P_{r_i}[T], play operators of the torque: a Prandtl-Ishlinskii loop      [kuhnen2003]

    Rate-independent, minor loops close. The half widths r_i spread over the torque the campaign reaches.
    """

    name: ClassVar[str] = "hysteretic_stiffness"
    in_short: ClassVar[str] = "rate-independent loop in torque against wind-up"
    source: ClassVar[str] = "seyfferth1995"
    shape_names: ClassVar[tuple[str, ...]] = ("T_h",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    WIDTHS: Final = (1.5, 4.0, 10.0, 25.0)  # N·m
    SPREAD: Final = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0)  # of T_h: half widths of the plays

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Loops the campaign's torque can go round."""
        return tuple((w,) for w in self.WIDTHS if w < 0.7 * reach.torque)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One play operator a half width."""
        torque = np.ascontiguousarray(np.nan_to_num(signals.torque))
        return {Port.WIND_UP: np.stack([play(torque, shape[0] * share) for share in self.SPREAD], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Wind-up between the branches at zero torque after a large swing, and the scale of the half widths."""
        gap = np.zeros(fit.covariance.shape[0])
        gap[: len(self.SPREAD)] = 2.0 * fit.shape[0] * np.array(self.SPREAD)
        width = np.zeros(fit.covariance.shape[0])
        width[-1] = 1.0
        value = float(gap[: len(self.SPREAD)] @ fit.coefficients[: len(self.SPREAD)])
        return (
            parameter("hysteresis_loss", value, fit.half_width(gap), "rad"),
            parameter("T_h", fit.shape[0], fit.half_width(width), "N·m"),
        )

    def plausible(self, fit: Fit) -> bool:
        """A loop loses energy: the branch on the way down lies behind."""
        return bool(np.dot(self.SPREAD, fit.coefficients[: len(self.SPREAD)]) > 0)
