"""Friction of motor and load: how large it is while sliding, what it holds at rest, how it wanders and warms."""

from __future__ import annotations

import math

from numba import njit

from sim.kernel import layout as at
from sim.kernel.layout import Slow, Vector


@njit
def stribeck(omega_m: float, p: Vector) -> float:
    """τ_c + (τ_s − τ_c)·exp(−(ω/ω_s)²), before the wander      [armstrong1994]"""
    x = omega_m * p[at.PER_OMEGA_S]
    return p[at.TAU_C] + (p[at.TAU_S] - p[at.TAU_C]) * math.exp(-x * x)


@njit
def uneven(theta_m: float, p: Vector) -> float:
    """1 + f·cos(nθ_m − ψ): friction by wave-generator angle."""
    return 1.0 + p[at.UNEVEN] * math.cos(p[at.UNEVEN_ORDER] * theta_m - p[at.UNEVEN_PHASE])


@njit
def sliding(theta_m: float, omega_m: float, elastic: float, level: float, slow: Slow | None, p: Vector) -> float:
    """Friction of the motor [N·m] while it turns: Stribeck's curve by angle, μ·|T|/N, drag by speed's powers.

    `level`: the wander, relative.
    """
    dry = level * stribeck(omega_m, p)
    if slow is None:
        return dry
    speed = abs(omega_m)
    drag = p[at.DRAG_2] * speed * speed
    if p[at.DRAG_23] != 0.0:
        drag += p[at.DRAG_23] * speed ** (2.0 / 3.0)
    return dry * uneven(theta_m, p) + p[at.MU] * p[at.PER_N] * abs(elastic) + drag


@njit
def breakaway(theta_m: float, elastic: float, level: float, slow: Slow | None, p: Vector) -> float:
    """What friction of the motor holds at rest [N·m]."""
    dry = level * p[at.TAU_S]
    if slow is None:
        return dry
    return dry * uneven(theta_m, p) + p[at.MU] * p[at.PER_N] * abs(elastic)


@njit
def wandered(x: float, dt: float, xi: float, p: Vector) -> float:
    """Ornstein-Uhlenbeck process after `dt` s, exact for any `dt`; `xi` from the standard normal distribution."""
    keep = math.exp(-dt / p[at.T_WANDER])
    return keep * x + p[at.WANDER] * math.sqrt(1.0 - keep * keep) * xi


@njit
def warm(state: Vector, p: Vector) -> None:
    """Friction and drag of the motor side as warm as the drive now is: factor exp(−β·ϑ), in place."""
    factor = math.exp(-p[at.BETA] * state[at.WARMTH])
    p[at.TAU_C], p[at.TAU_S] = factor * p[at.COLD_TAU_C], factor * p[at.COLD_TAU_S]
    p[at.B_M], p[at.B_ML] = factor * p[at.COLD_B_M], factor * p[at.COLD_B_ML]


@njit
def heat(state: Vector, p: Vector, joules: float, dt: float) -> None:
    """One thermal node, T·ϑ̇ = R·P − ϑ, exact while the power P lost on the motor side is steady."""
    keep = math.exp(-dt * p[at.PER_T_WARM])
    state[at.WARMTH] = keep * state[at.WARMTH] + (1.0 - keep) * p[at.WARMING] * joules / dt
