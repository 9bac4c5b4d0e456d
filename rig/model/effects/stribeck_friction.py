"""Friction that falls with speed near rest."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class StribeckFriction(Effect):
    """τ_f gains (τ_s − τ_c)·exp(−|ω_m/ω_s|^δ)·sgn ω_m      [armstrong1994]

    or with a τ_s − τ_c of its own each way; or, where an oil film builds up, (τ_s − τ_c)/(1 + |ω_m/ω_s|^p)·sgn ω_m,
    whose fall is as steep and goes on for longer      [hess1990]
    """

    name: ClassVar[str] = "stribeck_friction"
    in_short: ClassVar[str] = "friction falls with speed near rest"
    glosses: ClassVar[Mapping[str, str]] = {
        "tau_s_minus_tau_c": "τ_s − τ_c, friction at rest beyond the constant one",
        "tau_s_minus_tau_c_forward": "the same, when the motor turns forward",
        "tau_s_minus_tau_c_backward": "the same, when the motor turns backward",
        "omega_s": "ω_s, Stribeck speed of the motor, over which that falls off",
        "delta": "δ, exponent of how it falls with speed, exp(−|ω/ω_s|^δ)",
        "p": "p, exponent of how it falls with speed, 1/(1 + |ω/ω_s|^p)",
    }
    source: ClassVar[str] = "armstrong1994"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("omega_s", "delta", "by_way", "law")
    loose: ClassVar[tuple[bool, ...]] = (True, True, False, False)
    EXPONENTIAL, FILM = 0.0, 1.0
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType(
        {"delta": (1.0, 2.0), "by_way": (0.0,), "law": (EXPONENTIAL, FILM)}
    )
    SPEEDS: Final = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)  # rad/s, octaves from creep to what a gear's oil film allows
    CREEP: Final = 0.2  # of the fastest speed
    EXPONENTS: Final = (1.0, 2.0)  # what is reported: 0.5 to 2; between these two the curves differ by a tenth

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Speeds between half the slowest and the fastest."""
        speeds = [v for v in self.SPEEDS if 0.3 * reach.slowest < v < reach.fastest]
        both = tuple((v, d, 0.0, self.EXPONENTIAL) for v in speeds for d in self.EXPONENTS)
        by_way = ((v, self.EXPONENTS[0], 1.0, self.EXPONENTIAL) for v in speeds[::2])
        return (*both, *by_way, *((v, self.EXPONENTS[1], 0.0, self.FILM) for v in speeds[::2]))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, or two: forward, backward."""
        omega_s, delta, by_way, law = shape
        x = (np.abs(signals.omega_m) / omega_s) ** delta
        falls = signals.way * (1.0 / (1.0 + x) if law == self.FILM else np.exp(-x))
        forward = signals.way > 0
        return {Port.MOTOR_TORQUE: np.stack([falls * forward, falls * ~forward], 1) if by_way else falls[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """τ_s − τ_c, one or two, ω_s and the exponent."""
        names = ("tau_s_minus_tau_c_forward", "tau_s_minus_tau_c_backward") if fit.shape[2] else ("tau_s_minus_tau_c",)
        unit, k = np.eye(fit.covariance.shape[0]), len(names)
        excess = (parameter(name, fit.coefficients[i], fit.half_width(unit[i]), "N·m") for i, name in enumerate(names))
        return (
            *excess,
            parameter("omega_s", fit.shape[0], fit.half_width(unit[k]), "rad/s"),
            parameter("p" if fit.shape[3] == self.FILM else "delta", fit.shape[1], fit.half_width(unit[k + 1]), "1"),
        )

    def plausible(self, fit: Fit) -> bool:
        """Friction at rest is the larger one, whichever way the motor turns."""
        return bool(np.all(fit.coefficients > 0))

    def is_scaled(self, scale: Parameter, reach: Reach) -> bool:
        """Also where the fall lies in a gap between the speeds of the runs, and no run tells how steep it is: that
        creeping takes more friction than all faster running is the effect."""
        return super().is_scaled(scale, reach) or scale.ci95[1] < self.CREEP * reach.fastest

    def beyond(self, shape: Shape, reach: Reach) -> bool:
        """Where friction falls over all the speeds of a gear: no Stribeck effect but another curve of the speed."""
        return shape[0] > self.SPEEDS[-1]

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Of ω_s, of the exponent as it is reported; one size or two, and the law, are chosen."""
        return (0.3 * self.SPEEDS[0], 2.0 * self.SPEEDS[-1]), (0.5, 3.0), (0.0, 1.0), (self.EXPONENTIAL, self.FILM)
