"""One coast-down as numbers: deceleration by Coulomb and viscous friction, with the swing of the load on the gear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array

SKIP = 0.004  # s after the torque is taken off: the drive's torque loop, and one tick of delay
SLOWEST = 3.0  # rad/s  below it friction rises (Stribeck), which the law leaves out
FEWEST = 20  # rows of a coast
RATES = np.linspace(0.0, 30.0, 121)  # 1/s  B/J tried


@dataclass(frozen=True)
class Coast:
    """ω̇ = −a − b·ω from `omega_0` on, in the direction of motion; `b` is common to all coasts."""

    direction: int
    omega_0: float  # rad/s, where the torque was taken off, the swing left out
    a: float  # rad/s², Coulomb part τ_c/J
    tau_hold: float  # N·m that had held the speed, in the direction of motion


@dataclass(frozen=True)
class Piece:
    """The rows of one coast: time and angle from its first row, both (n,), in the direction of motion."""

    t: Array  # s
    theta: Array  # rad
    direction: int
    tau_hold: float  # N·m


def columns(t: Array, b: float, swing: complex) -> Array:
    """Columns (p, n) of θ(t): θ_0, ω_0 and a for the rate `b` 1/s, and the load's swing exp(s·t), s = `swing` 1/s.

    ω = ω_0·e^{−bt} − a·(1 − e^{−bt})/b gives θ = θ_0 + ω_0·g − a·(t − g)/b with g = (1 − e^{−bt})/b.
    """
    if b > 0.0:
        g = -np.expm1(-b * t) / b
        fall = (t - g) / b
    else:
        g, fall = t, 0.5 * t**2
    rows = [np.ones_like(t), g, -fall]
    if swing != 0:
        wave = np.exp(swing * t)
        rows += [wave.real, wave.imag]
    return np.array(rows)


def fit_coasts(pieces: list[Piece], swing: complex) -> tuple[list[Coast], float, float]:
    """(coasts, b, 1 σ of b) by least squares: b common to all, ω_0, a and the swing of each its own.

    Seen alone, a coast of a tenth of a second hardly bends; what bends all of them alike is b. Its σ is from leaving
    out one coast after the other (jackknife): friction that wanders is not the same twice.
    """
    costs = np.array([[_solve(p, float(b), swing)[1] for p in pieces] for b in RATES])  # (rates, pieces)
    b = _least(costs.sum(axis=1))
    left_out = np.array([_least(costs.sum(axis=1) - costs[:, k]) for k in range(len(pieces))])
    n = len(pieces)
    u = float(np.sqrt((n - 1) / n * np.sum((left_out - left_out.mean()) ** 2))) if n > 1 else float("nan")
    found = []
    for piece in pieces:
        c = _solve(piece, b, swing)[0]
        found.append(Coast(piece.direction, float(c[1]), float(c[2]), piece.tau_hold))
    return found, b, u


def _solve(piece: Piece, b: float, swing: complex) -> tuple[Array, float]:
    """Coefficients and the sum of squares they leave."""
    design = columns(piece.t, b, swing).T
    scale = np.sqrt(np.sum(design**2, axis=0))
    c = np.linalg.lstsq(design / scale, piece.theta, rcond=None)[0]
    rest = piece.theta - design / scale @ c
    return np.asarray(c / scale), float(rest @ rest)


def _least(cost: Array) -> float:
    """Where the cost is least, by a parabola through the best rate and its neighbours."""
    i = int(np.clip(np.argmin(cost), 1, cost.size - 2))
    low, mid, high = cost[i - 1], cost[i], cost[i + 1]
    bend = low - 2.0 * mid + high
    shift = 0.5 * (low - high) / bend if bend > 0 else 0.0
    return float(max(RATES[i] + np.clip(shift, -1.0, 1.0) * (RATES[1] - RATES[0]), 0.0))
