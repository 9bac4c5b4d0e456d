"""Where the energy is and where it went: the check no simulation of this rig may fail."""

from __future__ import annotations

from dataclasses import dataclass

from rig.model.gear import Gear


def stored(gear: Gear, omega_m: float, omega_l: float, phi: float) -> float:
    """T + V = ½·J_m·ω_m² + ½·J_l·ω_l² + ½·K·φ²  [J], `phi` rad at the output      [ghorbel2001, Eqs. 3-4]"""
    return 0.5 * (gear.J_m * omega_m**2 + gear.J_l * omega_l**2 + gear.K * phi**2)


@dataclass(frozen=True)
class Ledger:
    """Energy since the start [J]: work done on the rig, lost term by term, and what its store has gained."""

    motor: float  # ∫ τ_m·ω_m dt
    external: float  # ∫ τ_ext·ω_l dt
    B_m: float
    B_l: float
    B_ml: float
    B_sp: float
    friction_m: float
    friction_l: float
    stored: float

    @property
    def lost(self) -> float:
        """All that was turned to heat."""
        return self.B_m + self.B_l + self.B_ml + self.B_sp + self.friction_m + self.friction_l

    @property
    def residual(self) -> float:
        """Δ(T+V) + lost − work in; zero but for the integration's error      [ghorbel2001, Eqs. 3-7]"""
        return self.stored + self.lost - self.motor - self.external

    @property
    def throughput(self) -> float:
        """|work in| + lost: the scale the residual is held against."""
        return abs(self.motor) + abs(self.external) + self.lost
