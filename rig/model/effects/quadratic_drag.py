"""Drag that grows faster than speed."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class QuadraticDrag(Effect):
    """τ_f gains D·|ω_m/ω_r|^p·sgn ω_m, p about 2, ω_r = 10 rad/s so that D is a torque      [wolf2018]

    The blades of a fan or of a seal are curved: a D for either way of turning then.
    """

    name: ClassVar[str] = "quadratic_drag"
    in_short: ClassVar[str] = "drag with the square of speed"
    glosses: ClassVar[Mapping[str, str]] = {
        "drag_at_10_rad_s": "D, drag when the motor turns at 10 rad/s",
        "drag_forward_at_10_rad_s": "D forward, drag when the motor turns at +10 rad/s",
        "drag_backward_at_10_rad_s": "D backward, drag when the motor turns at −10 rad/s",
        "exponent": "p, power of the speed by which the drag grows",
    }
    source: ClassVar[str] = "wolf2018"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("by_way", "exponent")
    loose: ClassVar[tuple[bool, ...]] = (False, True)
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType({"exponent": (2.0,)})
    EXPONENTS: Final = (1.6, 2.0, 2.6)
    AT: Final = 10.0  # rad/s

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Around 2. Creep alone has no drag to speak of."""
        if reach.fastest <= 2.0 * reach.slowest:
            return ()
        return tuple((by_way, p) for by_way in (0.0, 1.0) for p in self.EXPONENTS)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """One D or two is chosen; an exponent below 1.3 is viscous, above 3.5 nothing known."""
        return (0.0, 1.0), (1.3, 3.5)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, or two: forward, backward."""
        by_way, exponent = shape
        forward = signals.omega_m > 0
        drag = np.sign(signals.omega_m) * np.abs(signals.omega_m / self.AT) ** exponent
        return {Port.MOTOR_TORQUE: np.stack([drag * forward, drag * ~forward], 1) if by_way else drag[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """D at 10 rad/s, one or two, and the exponent."""
        names = ("drag_forward_at_10_rad_s", "drag_backward_at_10_rad_s") if fit.shape[0] else ("drag_at_10_rad_s",)
        unit = np.eye(fit.covariance.shape[0])
        drags = (parameter(name, fit.coefficients[i], fit.half_width(unit[i]), "N·m") for i, name in enumerate(names))
        return (*drags, parameter("exponent", fit.shape[1], fit.half_width(unit[-1]), "1"))

    def plausible(self, fit: Fit) -> bool:
        """It brakes, whichever way the motor turns."""
        return bool(np.all(fit.coefficients > 0))
