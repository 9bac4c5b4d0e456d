"""Drag that grows faster than speed."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter

MOTOR, LOAD = 0.0, 1.0  # of the last shape parameter: who is braked


class QuadraticDrag(Effect):
    """τ_f gains D·|ω_m/ω_r|^p·sgn ω_m, p about 2, ω_r = 10 rad/s so that D is a torque      [wolf2018]

    The blades of a fan or of a seal are curved: a D for either way of turning then. What stirs oil or air may as well
    hang on the output: the load is resisted by D_l·|N·ω_l/ω_r|^p then.
    """

    name: ClassVar[str] = "quadratic_drag"
    in_short: ClassVar[str] = "drag with the square of speed"
    glosses: ClassVar[Mapping[str, str]] = {
        "drag_at_10_rad_s": "D, drag when the motor turns at 10 rad/s",
        "drag_forward_at_10_rad_s": "D forward, drag when the motor turns at +10 rad/s",
        "drag_backward_at_10_rad_s": "D backward, drag when the motor turns at −10 rad/s",
        "drag_of_load_at_10_rad_s": "D_l, drag of the load when the output turns as fast as with the motor at 10 rad/s",
        "exponent": "p, power of the speed by which the drag grows",
    }
    source: ClassVar[str] = "wolf2018"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("by_way", "exponent", "side")
    loose: ClassVar[tuple[bool, ...]] = (False, True, False)
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType({"exponent": (2.0,), "side": (MOTOR,)})
    EXPONENTS: Final = (1.6, 2.0, 2.6)
    AT: Final = 10.0  # rad/s
    WIDE: Final = 3.0  # fastest over slowest: a motor at one speed overshoots to twice that where it sets out

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Around 2. Creep alone has no drag to speak of, nor has one speed, whatever a motor does against a locked
        output: where it sets out and turns back a falling friction looks like it."""
        if reach.fastest <= self.WIDE * max(reach.slowest, reach.slowest_free):
            return ()
        kinds = ((0.0, MOTOR), (1.0, MOTOR), (0.0, LOAD))
        return tuple((by_way, p, side) for by_way, side in kinds for p in self.EXPONENTS)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """One D or two, and whose, is chosen; an exponent below 1.3 is viscous, above 3.5 nothing known."""
        return (0.0, 1.0), (1.3, 3.5), (MOTOR, LOAD)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, or two: forward, backward."""
        by_way, exponent, side = shape
        if side == LOAD:
            return {Port.LOAD_TORQUE: self._drag(signals.ratio * signals.omega_l, exponent)[:, None]}
        forward, drag = signals.omega_m > 0, self._drag(signals.omega_m, exponent)
        return {Port.MOTOR_TORQUE: np.stack([drag * forward, drag * ~forward], 1) if by_way else drag[:, None]}

    def _drag(self, omega: Array, exponent: float) -> Array:
        return np.asarray(np.sign(omega) * np.abs(omega / self.AT) ** exponent)

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """D at 10 rad/s, one or two, and the exponent."""
        one = "drag_of_load_at_10_rad_s" if fit.shape[2] == LOAD else "drag_at_10_rad_s"
        names = ("drag_forward_at_10_rad_s", "drag_backward_at_10_rad_s") if fit.shape[0] else (one,)
        unit = np.eye(fit.covariance.shape[0])
        p = unit[len(names) + 1]
        drags = (parameter(name, fit.coefficients[i], fit.half_width(unit[i]), "N·m") for i, name in enumerate(names))
        return (*drags, parameter("exponent", fit.shape[1], fit.half_width(p), "1"))

    def plausible(self, fit: Fit) -> bool:
        """It brakes, whichever way it turns."""
        return bool(np.all(fit.coefficients > 0))
