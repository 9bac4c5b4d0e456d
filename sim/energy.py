"""Where the energy is and where it went: the check no simulation of this rig may fail."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rig.model.gear import Gear
from sim.effects import Effects, Stiffness
from sim.parameters import TwinParameters
from sim.vector import bristles, slips


def stored(gear: Gear, omega_m: float, omega_l: float, phi: float) -> float:
    """T + V = ½·J_m·ω_m² + ½·J_l·ω_l² + ½·K·φ²  [J], `phi` rad at the output      [ghorbel2001, Eqs. 3-4]"""
    return 0.5 * (gear.J_m * omega_m**2 + gear.J_l * omega_l**2 + gear.K * phi**2)


@dataclass(frozen=True)
class Hidden:
    """States behind the motion: dashpots of creep, elements of hysteresis, then of presliding [rad]."""

    creep_1: float
    creep_2: float
    elements: tuple[float, ...]


def potential(parameters: TwinParameters, theta_m: float, theta_l: float, phi: float, hidden: Hidden) -> float:
    """Everything the rig holds beside its motion [J]: spring, creep, hysteresis, cogging, unbalance."""
    gear, e = parameters.gear, parameters.effects
    s, c, m, load = e.stiffness, e.creep, e.motor, e.load
    bent = past_gap(phi, math.radians(s.gap_deg))
    angle = s.by_angle_order * theta_m - math.radians(s.by_angle_deg)
    spring = straight_lines(gear.K, s, bent) + s.cubic * bent**4 / 4
    spring += 0.5 * gear.K * s.by_angle * math.cos(angle) * bent**2
    creep = 0.5 * (c.stiffness_1 * (phi - hidden.creep_1) ** 2 + c.stiffness_2 * (phi - hidden.creep_2) ** 2)
    k = (slips(e.hysteresis) + bristles(e.friction))[::2]
    elements = sum(0.5 * k_i * x_i**2 for k_i, x_i in zip(k, hidden.elements, strict=True))
    cogging = -m.cogging / m.cogging_order * math.sin(m.cogging_order * theta_m - math.radians(m.cogging_phase_deg))
    weight = -load.unbalance * math.cos(theta_l - math.radians(load.unbalance_phase_deg))
    return spring + creep + elements + cogging + weight


def past_gap(phi: float, gap: float) -> float:
    """φ beyond the dead zone of ±`gap` rad."""
    return math.copysign(max(abs(phi) - gap, 0.0), phi)


def straight_lines(K: float, s: Stiffness, bent: float) -> float:
    """∫ of the torque over K1, K2, K3 [J]."""
    if s.T1 == 0.0:
        return 0.5 * K * bent**2
    phi_1 = s.T1 / K
    knots = np.array([0.0, phi_1, phi_1 + (s.T2 - s.T1) / s.K2])
    spans = np.clip(abs(bent) - knots, 0.0, np.append(np.diff(knots), math.inf))
    return float(np.sum(np.array([0.0, s.T1, s.T2]) * spans + 0.5 * np.array([K, s.K2, s.K3]) * spans**2))


def spring_torque(K: float, effects: Effects, phi: float) -> float:
    """Torque of the spring's law alone [N·m] at `phi` rad: pieces and cube, no hysteresis, no creep, no angle."""
    s = effects.stiffness
    bent = past_gap(phi, math.radians(s.gap_deg))
    size = abs(bent)
    torque = K * size
    if s.T1 > 0.0:
        phi_1 = s.T1 / K
        phi_2 = phi_1 + (s.T2 - s.T1) / s.K2
        torque = float(np.interp(size, [0.0, phi_1, phi_2, phi_2 + 1.0], [0.0, s.T1, s.T2, s.T2 + s.K3]))
    return math.copysign(torque, bent) + s.cubic * bent**3


@dataclass(frozen=True)
class Ledger:
    """Energy since the start [J]: work done on the rig, lost term by term, and what its store has gained."""

    motor: float  # ∫ (τ_m + ripple)·ω_m dt
    external: float  # ∫ (τ_ext + vibration)·ω_l dt
    B_m: float
    B_l: float
    B_ml: float
    B_sp: float
    friction_m: float
    friction_l: float
    hysteresis: float
    creep: float
    schedule: float  # done on the spring while load changes the kinematic error, of either sign
    stored: float

    @property
    def lost(self) -> float:
        """All that was turned to heat."""
        dampers = self.B_m + self.B_l + self.B_ml + self.B_sp
        return dampers + self.friction_m + self.friction_l + self.hysteresis + self.creep

    @property
    def residual(self) -> float:
        """Δ(T+V) + lost − work in; zero but for the integration's error      [ghorbel2001, Eqs. 3-7]"""
        return self.stored + self.lost - self.motor - self.external - self.schedule

    @property
    def throughput(self) -> float:
        """|work in| + lost: the scale the residual is held against."""
        return abs(self.motor) + abs(self.external) + self.lost
