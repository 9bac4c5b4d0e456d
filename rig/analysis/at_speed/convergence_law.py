"""How the kinematic error grows with speed below the resonance, fitted to waveforms at several speeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.core.quantiles import Z95
from rig.core.units import TURN

Complex = npt.NDArray[np.complex128]
NEAR = 0.5  # r²  above it an order is too near its resonance (or beyond) for a law without damping
LEFT_OUT = 9.0  # χ² an order left out is charged with, 2 for its noise: a law that misses by 2 σ must not lose to none
SLOWEST_HZ, FASTEST_HZ, TRIALS = 1.0, 2000.0, 600  # natural frequencies tried, 1.3 % apart


@dataclass(frozen=True)
class SpeedStep:
    """θ̃ at one speed: phasors a_n − j·b_n of orders 1..k, arcsec, even part of both directions where both were run."""

    omega_m: float  # rad/s, magnitude
    phasor: Complex  # (k,)
    u: Array  # (k,) 1 σ of one part
    revolutions: int


@dataclass(frozen=True)
class Law:
    """θ̃_n(Ω) = θ̃_p,n / (1 − (nΩ/ω_0)²): inertia of the load on the gear's spring      [ghorbel2001, Eq. 7]"""

    omega_0: float  # rad/s; inf where no growth with speed can be told
    u_relative: float  # 1 σ of ω_0, relative
    pure: Complex  # (k,) θ̃_p,n, extrapolated to standstill, arcsec
    u_pure: Array  # (k,) 1 σ of one part
    misfit: float  # χ² per degree of freedom

    @property
    def resolved(self) -> bool:
        """Whether growth with speed stands out of the scatter: its 95 % interval excludes none at all."""
        return bool(np.isfinite(self.omega_0) and 2.0 * Z95 * self.u_relative < 1.0)

    def deviation(self, omega_m: float) -> float:
        """rms(θ̃(Ω) − θ̃_p)/rms(θ̃_p) at `omega_m` rad/s; inf from the first resonance of an order on."""
        return deviation(self.pure, omega_m, self.omega_0)

    def speed_at(self, tolerance: float) -> float:
        """The speed [rad/s] at which the deviation is `tolerance`."""
        return speed_at(self.pure, self.omega_0, tolerance)


def gains(orders: int, omega_m: float, omega_0: float) -> Array:
    """1/(1 − (nΩ/ω_0)²) of orders 1..`orders`, (k,); inf at and beyond resonance."""
    r2 = (np.arange(1.0, orders + 1) * omega_m / omega_0) ** 2
    return np.where(r2 < 1.0, 1.0 / np.where(r2 < 1.0, 1.0 - r2, 1.0), np.inf)


def deviation(pure: Complex, omega_m: float, omega_0: float) -> float:
    """rms of what speed adds over rms of the pure waveform; `pure` (k,), speeds rad/s."""
    added = gains(pure.size, omega_m, omega_0) - 1.0
    size = np.abs(pure)
    with np.errstate(invalid="ignore"):
        return float(np.sqrt(np.sum(np.where(size > 0, added * size, 0.0) ** 2) / np.sum(size**2)))


def speed_at(pure: Complex, omega_0: float, tolerance: float) -> float:
    """The speed [rad/s] at which `deviation` is `tolerance`, by bisection below the first resonance."""
    if not np.isfinite(omega_0):
        return float("inf")
    low, high = 0.0, omega_0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if deviation(pure, middle, omega_0) < tolerance else (low, middle)
    return low


def fit_law(steps: list[SpeedStep]) -> Law:
    """Weighted least squares over all speeds and orders; ω_0 by trial, θ̃_p,n linear for each trial.

    An order nearer its resonance than r² = NEAR is left out at that speed and charged with LEFT_OUT, so that
    leaving out gains nothing. The scatter widens the interval where the law misses more than noise.
    """
    z = np.array([s.phasor for s in steps])  # (speeds, k)
    weight = 1.0 / np.array([s.u for s in steps]) ** 2
    frequency = np.multiply.outer([s.omega_m for s in steps], np.arange(1.0, z.shape[1] + 1))
    trials = 1.0 / (TURN * np.geomspace(SLOWEST_HZ, FASTEST_HZ, TRIALS)) ** 2
    costs = np.array([_cost(z, weight, frequency, x)[0] for x in trials])
    best = int(np.argmin(costs))
    x = _refined(z, weight, frequency, trials, best)
    cost, pure, total = _cost(z, weight, frequency, x)
    out = int(np.sum(x * frequency**2 >= NEAR))
    dof = max(2 * (z.size - out - z.shape[1]) - 1, 1)
    misfit = max((cost - LEFT_OUT * out) / dof, 1e-300)
    step = 0.02 * x
    bend = (_masked(z, weight, frequency, x + step, x) + _masked(z, weight, frequency, x - step, x)) / step**2
    bend -= 2.0 * _masked(z, weight, frequency, x, x) / step**2
    u_x = float(np.sqrt(2.0 / max(bend, 1e-300) * max(misfit, 1.0)))
    at_edge = best in (0, TRIALS - 1)
    u_pure = np.sqrt(max(misfit, 1.0) / np.maximum(total, 1e-300))
    return Law(float("inf") if at_edge else float(1.0 / np.sqrt(x)), 0.5 * u_x / x, pure, u_pure, misfit)


def _cost(z: Complex, weight: Array, frequency: Array, x: float) -> tuple[float, Complex, Array]:
    """(χ², θ̃_p,n, its weight) for 1/ω_0² = `x`; orders left out are charged."""
    r2 = x * frequency**2
    used = r2 < NEAR
    gain = 1.0 / (1.0 - np.where(used, r2, 0.0))
    w = np.where(used, weight, 0.0)
    total = np.sum(w * gain**2, axis=0)
    pure = np.sum(w * gain * z, axis=0) / np.maximum(total, 1e-300)
    return float(np.sum(w * np.abs(z - gain * pure) ** 2) + LEFT_OUT * np.sum(~used)), pure, total


def _masked(z: Complex, weight: Array, frequency: Array, x: float, at: float) -> float:
    """χ² for `x` with the orders that are used at `at`: the curvature must not see orders come and go."""
    return _cost(
        z, np.where(at * frequency**2 < NEAR, weight, 0.0), np.where(at * frequency**2 < NEAR, frequency, 0.0), x
    )[0]


def _refined(z: Complex, weight: Array, frequency: Array, trials: Array, best: int) -> float:
    """The least χ² near the best trial, by golden section with the orders of that trial."""
    low, high = float(trials[min(best + 1, TRIALS - 1)]), float(trials[max(best - 1, 0)])
    at, golden = float(trials[best]), 0.5 * (np.sqrt(5.0) - 1.0)
    for _ in range(40):
        a, b = high - golden * (high - low), low + golden * (high - low)
        if _masked(z, weight, frequency, a, at) < _masked(z, weight, frequency, b, at):
            high = b
        else:
            low = a
    return 0.5 * (low + high)
