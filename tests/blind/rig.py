"""The true rig of a case: its own numbers, ±30 % around a drive of size 40 like the paper's, all of it assumed."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

NOMINAL_K = 7160.0  # N·m/rad, what every manifest declares: the paper's value
HARMONICS = 15


@dataclass(frozen=True)
class Rig:
    """True numbers, SI; dampings in N·m·s/rad, friction in N·m, kinematic error coefficients in rad (order 1 first)."""

    J_m: float
    J_l: float
    K: float
    B_m: float
    B_l: float
    B_ml: float
    B_sp: float
    T_c: float
    T_l: float
    ke_cos: tuple[float, ...]
    ke_sin: tuple[float, ...]
    N: float = 50.0

    def resonance_hz(self) -> float:
        """Free-free torsional frequency, Hz [physics 1.4]."""
        inertia = self.J_l * self.N**2 * self.J_m / (self.J_l + self.N**2 * self.J_m)
        return float(np.sqrt(self.K / inertia) / (2 * np.pi))

    def running_torque(self, speed: float) -> float:
        """Motor torque, N·m, that holds `speed` (rad/s) against the friction of the baseline."""
        viscous = self.B_m + self.B_ml * (1 + 1 / self.N) ** 2 + self.B_l / self.N**2
        return float(np.sign(speed) * (self.T_c + self.T_l / self.N) + viscous * speed)

    def as_truth(self) -> dict[str, object]:
        return asdict(self)


def kinematic_error(rng: np.random.Generator) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Fifteen orders: the second leads, even ones stand out, the tail falls [physics 2.5, proportions]."""
    size = (
        np.array([30e-6 if n % 2 == 0 else 16e-6 for n in range(1, HARMONICS + 1)]) / np.arange(1, HARMONICS + 1) ** 0.4
    )
    size[0], size[1], size[3] = 45e-6, 320e-6, 85e-6
    size = size * rng.uniform(0.7, 1.3, HARMONICS)
    phase = rng.uniform(0, 2 * np.pi, HARMONICS)
    return tuple((size * np.cos(phase)).tolist()), tuple((size * np.sin(phase)).tolist())


def draw(rng: np.random.Generator, lowest_hz: float, highest_hz: float) -> Rig:
    """A rig whose resonance lies between the two frequencies (redrawn until it does): no steady run sits on it."""
    while True:
        spread = rng.uniform(0.7, 1.3, 9)
        a, b = kinematic_error(rng)
        rig = Rig(
            J_m=1.35e-3 * spread[0],
            J_l=0.72 * spread[1],
            K=NOMINAL_K * (0.5 + 0.5 * spread[2]) * 1.02,
            B_m=2.7e-3 * spread[3],
            B_l=1.0 * spread[4],
            B_ml=1.2e-3 * spread[5],
            B_sp=6.8 * spread[6],
            T_c=0.16 * spread[7],
            T_l=0.42 * spread[8],
            ke_cos=a,
            ke_sin=b,
        )
        if lowest_hz < rig.resonance_hz() < highest_hz:
            return rig
