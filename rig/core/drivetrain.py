"""What a torque that nothing corrects does to the rig, from declared numbers: before it is given, not after."""

from __future__ import annotations

import math
from dataclasses import dataclass

RATIOS = (1e-3, 1e5)  # no gear's is outside


@dataclass(frozen=True)
class Drivetrain:
    """Motor, gear and free load as two inertias on a spring, seen at the motor. SI.

    Friction that nobody declared counts as none: what is predicted is then the most that can be.
    """

    J_m: float  # kg·m², motor side
    J_l: float  # kg·m², load side over N²
    B: float  # N·m·s/rad, all damping
    tau_c: float  # N·m, all Coulomb friction
    omega_n: float  # rad/s, of the torsional mode, both ends free
    zeta: float  # its damping ratio
    ratio: float  # N

    def speed_after(self, tau: float, seconds: float, before: float = 0.0) -> float:
        """rad/s, at least 0: the motor turning at `before` rad/s, after `seconds` s of `tau` ≥ 0 N·m.

        J·ω̇ = τ − τ_c − B·ω, both inertias as one.
        """
        J, drive = self.J_m + self.J_l, tau - self.tau_c
        decay = self.B * seconds / J
        gained = drive * seconds / J if decay < 1e-9 else -math.expm1(-decay) * drive / self.B
        return max(before * math.exp(-decay) + gained, 0.0)

    def step_speed(self, tau: float, seconds: float) -> float:
        """rad/s the motor reaches at most when `tau` N·m are switched on at rest for `seconds` s.

        For the first moments the spring has not taken the load along: ω_m = (τ/J)·(t + (J_l/J_m)·sin(ω_n·t)/ω_n), so
        that it is ahead by no more than so much time.
        """
        return self.speed_after(tau, seconds + self.J_l / (self.J_m * self.omega_n))

    def step_shaft_torque(self, tau: float, apart: float) -> float:
        """N·m at the output at most when `tau` N·m are switched on and off again and again, pairs `apart` s apart.

        Each switch swings the spring by A = N·τ·J_l/J about where the torque leaves it, up to 2·A; what is left of the
        swings before adds to it.
        """
        swing = self.ratio * tau * self.J_l / (self.J_m + self.J_l)
        left = math.exp(-self.zeta * self.omega_n * apart)
        return 2.0 * swing / (1.0 - left) if left < 1.0 else math.inf
