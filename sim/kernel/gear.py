"""The gear: kinematic error, spring torque, damping, and what acts on either side beside friction."""

from __future__ import annotations

import math

from numba import njit

from sim.kernel import layout as at
from sim.kernel.layout import Error, Four, Mesh, Pair, Slow, Spring, Three, Vector


@njit
def kinematic_error(theta: float, slow: Slow | None, p: Vector) -> Error:
    """θ̃_p, dθ̃_p/dθ_m, dθ̃_p/dT̄ by the recurrence c_{n+1} = 2·c_1·c_n − c_{n−1}      [ghorbel2001, Eq. 8]"""
    c, s = math.cos(theta), math.sin(theta)
    twice, c_last, s_last = 2.0 * c, 1.0, 0.0
    value, slope = 0.0, 0.0
    place = int(p[at.SERIES_AT])
    for _ in range(int(p[at.TERMS])):
        value += p[place] * c + p[place + 1] * s
        slope += p[place + 3] * c - p[place + 2] * s
        c, c_last = twice * c - c_last, c
        s, s_last = twice * s - s_last, s
        place += 4
    if slow is None:
        return Error(value, slope, 0.0)
    return beyond_the_series(theta, slow.load, value, slope, p)


@njit
def beyond_the_series(theta: float, load: float, value: float, slope: float, p: Vector) -> Error:
    """g(T̄)·(Eq. 8) and orders outside of it: g = A_∞ + (A_0 − A_∞)·exp(−T̄/T_c)      [ghorbel2001, Fig. 9]"""
    fall = (p[at.A_0] - p[at.A_INF]) * math.exp(-load * p[at.PER_T_C])
    size, per_load = p[at.A_INF] + fall, -fall * p[at.PER_T_C] * value
    value, slope = size * value, size * slope
    place = int(p[at.LINES_AT])
    for _ in range(int(p[at.LINES])):
        order = p[place]
        c, s = math.cos(order * theta), math.sin(order * theta)
        value += p[place + 1] * c + p[place + 2] * s
        slope += order * (p[place + 2] * c - p[place + 1] * s)
        place += 3
    return Error(value, slope, per_load)


@njit
def mesh(y: Four, slow: Slow | None, error: Error, outside: Three, spring: Spring, p: Vector) -> Mesh:
    """Torque of the gear on motor and load, and the powers lost in B_ml and B_sp      [ghorbel2001, Eqs. 5-7]

    φ = θ_l − θ_m/N + θ̃_p,  S = K·φ + B_sp·φ̇,  M = B_ml·(ω_m + σ·ω_l):  −S·(θ̃_p′ − 1/N) − M and −S − σ·M
    `outside`: motor torque asked, torque on the load, time.
    """
    theta_m, omega_m, theta_l, omega_l = y
    lever = error.slope - p[at.PER_N]
    phi = theta_l - theta_m * p[at.PER_N] + error.value
    phi_rate = omega_l + lever * omega_m
    elastic = spring.twist.offset + spring.twist.slope * phi
    slip = omega_m + p[at.SIGMA] * omega_l
    drag = p[at.B_ML] * slip
    if slow is not None:
        return full_mesh(y, slow, error, outside, spring, p, phi, phi_rate, elastic, drag * slip)
    torque = elastic + p[at.B_SP] * phi_rate
    on_motor, on_load = -torque * lever - drag, -torque - p[at.SIGMA] * drag
    lost_sp = p[at.B_SP] * phi_rate**2
    return Mesh(
        on_motor, on_load, 0.0, 0.0, drag * slip, lost_sp, phi, phi_rate, elastic, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    )


@njit
def on_the_motor(theta_m: float, tau: float, p: Vector) -> Pair:
    """Cogging and ripple [N·m], and of that the ripple: r·τ·cos(nθ_m − ψ) of the torque asked."""
    cogging, ripple = 0.0, 0.0
    if p[at.COGGING] != 0.0:
        cogging = p[at.COGGING] * math.cos(p[at.COGGING_ORDER] * theta_m - p[at.COGGING_PHASE])
    if p[at.RIPPLE] != 0.0:
        ripple = p[at.RIPPLE] * tau * math.cos(p[at.RIPPLE_ORDER] * theta_m - p[at.RIPPLE_PHASE])
    return cogging + ripple, ripple


@njit
def on_the_load(theta_l: float, t: float, p: Vector) -> Pair:
    """Unbalance and vibration [N·m], and of that the vibration."""
    weight, shake = 0.0, 0.0
    if p[at.UNBALANCE] != 0.0:
        weight = -p[at.UNBALANCE] * math.sin(theta_l - p[at.UNBALANCE_PHASE])
    if p[at.SHAKE] != 0.0:
        shake = p[at.SHAKE] * math.sin(p[at.SHAKE_RATE] * t + p[at.SHAKE_PHASE])
    return weight + shake, shake


@njit
def full_mesh(
    y: Four,
    slow: Slow,
    error: Error,
    outside: Three,
    spring: Spring,
    p: Vector,
    phi: float,
    phi_rate: float,
    elastic: float,
    lost_ml: float,
) -> Mesh:
    """The same with everything the paper's model lacks. φ̇ has a part θ̃_p by load, whose work stands apart."""
    theta_m, omega_m, _, omega_l = y
    lever, bent = error.slope - p[at.PER_N], spring.live * (phi - spring.shift)
    aside_m, ripple = on_the_motor(theta_m, outside[0], p)
    aside_l, shake = on_the_load(y[2], outside[2], p)
    aside_m -= spring.bristles.offset + spring.bristles.slope * theta_m
    elastic += p[at.CUBIC] * bent**3
    if p[at.KAPPA] != 0.0:  # V = ½·κ·cos(nθ − ψ)·φ²
        angle = p[at.KAPPA_ORDER] * theta_m - p[at.KAPPA_PHASE]
        elastic += p[at.KAPPA] * math.cos(angle) * bent
        aside_m += 0.5 * p[at.KAPPA] * p[at.KAPPA_ORDER] * math.sin(angle) * bent**2
    behind_1, behind_2 = phi - slow.creep_1, phi - slow.creep_2
    creep_1, creep_2 = p[at.CREEP_PER_T_1] * behind_1, p[at.CREEP_PER_T_2] * behind_2
    elastic += p[at.CREEP_K_1] * behind_1 + p[at.CREEP_K_2] * behind_2
    lost_creep = p[at.CREEP_K_1] * behind_1 * creep_1 + p[at.CREEP_K_2] * behind_2 * creep_2
    load = p[at.PER_T_LOAD] * (abs(elastic) - slow.load)
    shrinking = error.per_load * load
    phi_rate += shrinking
    torque = elastic + p[at.B_SP] * phi_rate
    drag = p[at.B_ML] * (omega_m + p[at.SIGMA] * omega_l)
    return Mesh(
        on_motor=-torque * lever - drag,
        on_load=-torque - p[at.SIGMA] * drag,
        aside_m=aside_m,
        aside_l=aside_l,
        lost_ml=lost_ml,
        lost_sp=p[at.B_SP] * phi_rate**2,
        phi=phi,
        phi_rate=phi_rate,
        elastic=elastic,
        load=load,
        creep_1=creep_1,
        creep_2=creep_2,
        lost_creep=lost_creep,
        schedule=torque * shrinking,
        ripple=ripple * omega_m,
        shake=shake * omega_l,
    )
