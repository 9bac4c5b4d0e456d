"""The angle between the zeros of two runs' motor encoders, from the kinematic error both have seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.core.quantiles import Z95
from rig.core.units import DEG, TURN

Complex = npt.NDArray[np.complex128]
GRID = 1440  # trial shifts a turn, 0.25° apart: order 15 has 24° a period
COMMON = 6.0 * DEG  # rad  other zeros differ by anything: in 29 cases of 30 by more than this
NONE = 1.0 * DEG  # rad  and below this the shift is none: order 2 moves by 1/30
SIGMA = 3.0  # as is one below so many of its own σ
LIKE = 0.3  # of what two slow errors differ by: a shift that leaves more of it is not what they differ by
MODEL = 0.15  # of what the model says an order gains: how far it is believed


@dataclass(frozen=True)
class Alignment:
    """θ of the one run = θ of the other + shift; both zeros common where the shift is exactly 0."""

    shift: float  # rad of the motor
    u: float  # rad, 1 σ; 0 where the zero is common
    fitted: float  # rad, what the fit gave
    u_fitted: float  # rad, 1 σ

    @property
    def common(self) -> bool:
        """Whether the encoder kept its zero between the runs."""
        return self.shift == 0.0 and self.u == 0.0

    @property
    def odd(self) -> bool:
        """Whether one zero is likely and yet the runs do not lie on each other."""
        return self.common and abs(self.fitted) > max(NONE, SIGMA * self.u_fitted)

    @property
    def sentence(self) -> str:
        """Which way was taken, with the numbers."""
        fitted = f"{self.fitted / DEG:.2f}° ± {Z95 * self.u_fitted / DEG:.2f}°"
        if self.odd:
            return (
                f"Both runs seem to count the motor angle from one zero, and yet a shift of {fitted} fits better: "
                "encoders read at different times, or dynamics that the linear model lacks; none used."
            )
        if self.common:
            return (
                f"Both runs count the motor angle from one zero (the best shift between them is {fitted}): none used."
            )
        return (
            f"The runs count the motor angle from different zeros; the slow run was turned by {fitted}, the shift that "
            "fits best. An error of it is in the intervals."
        )


def align(total: Complex, expected: Complex, u: Array, trusted: int) -> Alignment | None:
    """The shift δ that makes `expected`·exp(−jnδ) most like `total`, both (k,) phasors of orders 1..k; `u` 1 σ (k,).

    Only the first `trusted` orders vote. Weighted least squares: a grid over the turn, then Newton on the phase. None
    when nothing stands out of the noise.
    """
    n = np.arange(1.0, total.size + 1)[:trusted]
    z, p, s = total[:trusted], expected[:trusted], u[:trusted]
    sigma2 = s**2 + (MODEL * np.abs(np.abs(z) - np.abs(p))) ** 2 + 1e-12
    if not np.isfinite(sigma2).all() or not (np.abs(z) > 3.0 * s).any():
        return None
    trial = np.linspace(-TURN / 2, TURN / 2, GRID, endpoint=False)
    cost = np.sum(np.abs(z - p * np.exp(-1j * np.multiply.outer(trial, n))) ** 2 / sigma2, axis=1)
    shift = float(trial[int(np.argmin(cost))])
    for _ in range(20):
        model = p * np.exp(-1j * n * shift)
        slope = -1j * n * model
        step = float(np.sum(np.real(np.conj(slope) * (z - model)) / sigma2) / np.sum(np.abs(slope) ** 2 / sigma2))
        shift += step
        if abs(step) < 1e-9:
            break
    model = p * np.exp(-1j * n * shift)
    curvature = float(np.sum((n * np.abs(model)) ** 2 / sigma2))
    chi2 = float(np.sum(np.abs(z - model) ** 2 / sigma2)) / max(2 * n.size - 1, 1)
    sigma = float(np.sqrt(max(chi2, 1.0) / curvature))
    if abs(shift) < COMMON:
        return Alignment(0.0, 0.0, shift, sigma)
    return Alignment(shift, sigma, shift, sigma)


def other_zero(seen: Complex, expected: Complex, u: Array) -> Alignment | None:
    """The shift between two slow errors, (k,) phasors of orders 1..k each, `u` 1 σ of their difference (k,), where it
    makes them alike; None where there is none, or something else differs too."""
    where = align(seen, expected, u, seen.size)
    if where is None or where.common:
        return None
    gone = np.linalg.norm(seen - turned(expected, where.shift)) < LIKE * np.linalg.norm(seen - expected)
    return where if gone else None


def turned(phasors: Complex, shift: float) -> Complex:
    """Phasors of orders 1..k, (k,), as an encoder reads them whose zero is `shift` rad of the motor away."""
    return np.asarray(phasors * np.exp(-1j * np.arange(1.0, phasors.size + 1) * shift))
