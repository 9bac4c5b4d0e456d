"""Equation 8: the pure kinematic error as a Fourier series of the motor angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
BLOCK: Final = 4096  # angles
PAPER_ORDERS: Final = 15  # of the motor, in the paper's series      [ghorbel2001, Eq. 8]


@dataclass(frozen=True)
class FourierSeries:
    """θ̃_p(θ_m) = Σ_{n=1..k} [a_n cos nθ_m + b_n sin nθ_m]      [ghorbel2001, Eq. 8]

    `a`, `b`: shape (k,), rad at the output, orders 1..k. The constant a_0/2 is left out: with
    encoders of arbitrary zero it cannot be observed.
    """

    a: tuple[float, ...]
    b: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.a) != len(self.b):
            raise ValueError(f"{len(self.a)} cosine and {len(self.b)} sine coefficients, expected as many of each")

    @classmethod
    def from_polar(cls, amplitude: Array, phase: Array) -> FourierSeries:
        """C_n cos(nθ_m − ψ_n): `amplitude` C_n rad and `phase` ψ_n rad, shape (k,), orders 1..k."""
        return cls(tuple(map(float, amplitude * np.cos(phase))), tuple(map(float, amplitude * np.sin(phase))))

    @property
    def orders(self) -> Array:
        """1..k, cycles per motor turn, shape (k,)."""
        return np.arange(1, len(self.a) + 1, dtype=np.float64)

    @property
    def amplitude(self) -> Array:
        """C_n = √(a_n² + b_n²), rad, shape (k,)."""
        return np.hypot(self.a, self.b)

    @property
    def phase(self) -> Array:
        """ψ_n = atan2(b_n, a_n), rad, shape (k,)."""
        return np.arctan2(self.b, self.a)

    def value(self, theta_m: Array) -> Array:
        """θ̃_p at `theta_m` rad (any shape), rad."""
        return self._summed(theta_m, 0)

    def slope(self, theta_m: Array) -> Array:
        """dθ̃_p/dθ_m at `theta_m` rad (any shape), rad/rad."""
        return self._summed(theta_m, 1)

    def _summed(self, theta_m: Array, derivative: int) -> Array:
        """Re Σ (i·n)^derivative·(a_n − i·b_n)·e^{inθ} by Horner's rule: one sine and cosine an angle, not one an order;
        in blocks that stay in the cache. Of long runs `rig.model.waves` has the same compiled."""
        terms = (1j * self.orders) ** derivative * (np.asarray(self.a) - 1j * np.asarray(self.b))
        angles = np.asarray(theta_m, dtype=np.float64)
        flat, out = angles.reshape(-1), np.zeros(angles.size)
        for start in range(0, flat.size, BLOCK):
            block = flat[start : start + BLOCK]
            wave = np.cos(block) + 1j * np.sin(block)
            total = np.zeros_like(wave)
            for term in terms[::-1]:
                total += term
                total *= wave
            out[start : start + BLOCK] = total.real
        return out.reshape(angles.shape)

    def peak_to_peak(self) -> float:
        """max − min over one motor turn, rad, on a grid of 64 points per highest order."""
        grid = np.linspace(0.0, 2 * np.pi, 64 * max(len(self.a), 1), endpoint=False)
        curve = self.value(grid)
        return float(np.ptp(curve))
