"""Friction that grows with the torque that goes through the mesh."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class LoadDependentFriction(Effect):
    """τ_f gains μ_L·T_0/N·|T/T_0|^p·sgn ω_m, T_0 = 20 N·m; with p = 1 the load-only efficiency is 1/(1 + μ_L)

    Friction of a mixed film grows less than the load, of teeth that dig in more: p is fitted. Teeth that slide
    otherwise when the load drives have another μ_L then: one for either flow of power. Contacts that bear on all their
    area have no more to gain: (1 − exp(−|T|/T_s))/(1 − exp(−T_0/T_s)) in the place of the power then.
    """

    name: ClassVar[str] = "load_dependent_friction"
    in_short: ClassVar[str] = "friction grows with transmitted torque"
    glosses: ClassVar[Mapping[str, str]] = {
        "mu_L": "μ_L, N times the friction of the motor over the torque through the gear, at 20 N·m",
        "mu_L_driving": "μ_L where the motor drives, N times the friction of the motor over that torque, at 20 N·m",
        "mu_L_driven": "μ_L where the load drives, N times the friction of the motor over that torque, at 20 N·m",
        "exponent": "p, power of the load by which the friction grows",
        "T_s": "T_s, torque through the gear over which the friction saturates",
    }
    source: ClassVar[str] = "tuttle1992"
    shape_names: ClassVar[tuple[str, ...]] = ("by_flow", "exponent", "law")  # exponent: T_s/T_0 where it saturates
    loose: ClassVar[tuple[bool, ...]] = (False, True, False)
    POWER, SATURATING = 0.0, 1.0
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType(
        {"exponent": (1.0,), "law": (POWER, SATURATING)}
    )
    AT: Final = 20.0  # N·m, where μ_L is told: the middle of a load sweep
    MOST: Final = 3.0  # of μ_L: a gear that loses as much as it gives has 1; hundreds are a torque in another unit
    UNSURE: Final = 0.25  # of the larger μ_L, how negative noise may make the other
    HERTZ: Final = 2 / 3
    EXPONENTS: Final = (0.4, 2.0)  # Hertzian contacts 2/3, dry friction 1, bending of the cup 2

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One μ_L, or one for either flow of power: where the motor's torque alone tells how heavy the load is, a load
        that is heavier and loses more when it drives is the same."""
        told = "tau_l" in reach.has or reach.weights > 1
        one = ((0.0, 1.0, self.POWER), (0.0, 0.5, self.SATURATING))
        # where the motor loses alone, and by a root of the load, a straight line wants less than nothing of the other
        each = ((1.0, 1.0, self.POWER), (1.0, self.HERTZ, self.POWER))
        return (*one, *each) if told else one

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """The flow and the law are chosen, not fitted."""
        return (0.0, 1.0), self.EXPONENTS, (self.POWER, self.SATURATING)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, or two: motor driving, load driving."""
        by_flow, exponent, law = shape
        load = np.abs(signals.torque / self.AT)
        grown = np.expm1(-load / exponent) / np.expm1(-1 / exponent) if law == self.SATURATING else load**exponent
        loss = self.AT / signals.ratio * grown * signals.way
        if not by_flow:
            return {Port.MOTOR_TORQUE: loss[:, None]}
        driving = signals.torque * signals.way > 0
        return {Port.MOTOR_TORQUE: np.stack([loss * driving, loss * ~driving], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """μ_L at T_0, one or two, and how the friction grows with the load."""
        names = ("mu_L_driving", "mu_L_driven") if fit.shape[0] else ("mu_L",)
        unit = np.eye(fit.covariance.shape[0])
        shares = (parameter(name, fit.coefficients[i], fit.half_width(unit[i]), "1") for i, name in enumerate(names))
        half = fit.half_width(unit[len(names) + 1])
        if fit.shape[2] == self.SATURATING:
            return (*shares, parameter("T_s", self.AT * fit.shape[1], self.AT * half, "N·m"))
        return (*shares, parameter("exponent", fit.shape[1], half, "1"))

    def plausible(self, fit: Fit) -> bool:
        """Losses grow with the load, stay below a few times it, and give no energy back, whichever way it flows."""
        most, least = float(np.max(fit.coefficients)), float(np.min(fit.coefficients))
        return 0 < most < self.MOST and least > -self.UNSURE * most
