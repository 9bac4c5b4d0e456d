"""The gear's forces and one integration step, compiled. Written for the blind test alone.

Scheme: drift-kick-drift in the positions (Moreau's midpoint rule), rigid dry friction as the exact set-valued law at
velocity level, so a motor at rest sticks for good and no regularisation creeps. Second order for the conservative part;
the step keeps books of every work it does, which is what the energy test adds up.
Sources of the laws: Ghorbel, Gandhi, Alpeter 2001, Eqs. 5-7; Moreau 1988 (time stepping); Bouc 1967, Wen 1976;
Canudas de Wit 1995 (LuGre); Iwan 1966 (parallel elasto-slip).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

compiled = njit(cache=True, error_model="numpy", fastmath=True)

# state vector: positions, velocities, memories, books
TH, W, TL, WL, X, VX = 0, 1, 2, 3, 4, 5
T_SLOW, HEAT, LAG = 6, 7, 8  # low-passed |torque|, heat above ambient, direction memory of the kinematic error
Z_FRIC, Z_HYST, Z_CREEP = 10, 14, 24  # 4, 10 and 4 places
TORQUE = 28  # torque the sensor feels, gear to load
W_IN, W_DISS = 30, 31  # work put in and dissipated since the start, J
STATE_SIZE = 32

RIGID, COUPLING, DISC, HOUSING, SENSOR_SHAFT = 0, 1, 2, 3, 4  # where the extra degree of freedom sits
DRY, LUGRE, ELEMENTS = 0, 1, 2  # friction near rest
MAXWELL, BOUC_WEN = 1, 2  # hysteresis in the deflection

TWO_PI = 2.0 * np.pi
TURN = 8192  # entries of a one-turn table: 40 per cycle of order 204
SPEED_STEP, SPEED_SIZE = 0.01, 7501  # rad/s; up to 716 rpm, above every plan
LOAD_STEP, LOAD_SIZE = 0.1, 3001  # N·m
DEFLECTION_STEP, DEFLECTION_SIZE = 2e-6, 40001  # rad; ±0.04 rad are 280 N·m at the nominal stiffness


class Par(NamedTuple):
    """Scalars of the true rig, SI."""

    N: float
    J_m: float
    J_l: float
    K: float
    B_m: float
    B_l: float
    B_ml: float
    B_sp: float
    T_c: float
    T_l: float
    extra: int
    J_x: float
    k_x: float
    c_x: float
    dry_x: float
    friction: int
    sigma_0: float
    sigma_1: float
    share: float
    hysteresis: int
    bw_k: float
    bw_x: float
    bw_beta: float
    bw_n: float
    bw_delta: float
    slip_back: float
    t_slow: float
    back_driven: float
    heat_gain: float
    heat_tau: float
    warm_c: float
    warm_v: float
    warm_tau_1: float
    warm_tau_2: float
    warm_share: float
    aging: float
    aging_tau: float
    ke_aging: float
    lag_angle: float
    lag_scale: float
    dead_zone: float
    odd_order: float
    odd_size: float
    odd_phase: float
    warm_root: int
    locked: int


class Tab(NamedTuple):
    """Where each look-up table begins in the one array `data`; 0 = switched off. One-turn tables: TURN + 1 values (the
    first again at the end), then their TURN + 1 slopes. One array, for a tuple of many costs more than the physics.
    """

    p: int
    p_load: int
    p_frame: int
    p_out: int
    friction_angle: int
    friction_frame: int
    stiff_m: int
    stiff_l: int
    cogging: int
    ripple: int
    on_load: int
    encoder_m: int
    pulley: int
    ke_gain: int
    friction_forward: int
    friction_backward: int
    friction_load: int
    spring: int
    slip_k: int
    slip_x: int
    slips: int
    creep_k: int
    creep_tau: int
    creeps: int
    play_k: int
    play_x: int
    plays: int


@compiled
def periodic(data, at, angle):
    """Cubic Hermite value and slope of the one-turn table at `at` for `angle`, rad."""
    if at == 0:
        return 0.0, 0.0
    u = angle * (1.0 / TWO_PI)
    u = (u - np.floor(u)) * TURN
    i = min(int(u), TURN - 1)
    f = u - i
    h = TWO_PI / TURN
    i += at
    a, b, c, d = data[i], data[i + 1], data[i + TURN + 1] * h, data[i + TURN + 2] * h
    e = b - a
    k2, k3 = 3 * e - 2 * c - d, c + d - 2 * e
    return a + f * (c + f * (k2 + f * k3)), (c + f * (2 * k2 + 3 * f * k3)) / h


@compiled
def ramp(data, at, size, x, step):
    """Linear value of a table of `size` entries that starts at x = 0; the last slope goes on."""
    if at == 0:
        return 0.0
    u = x / step
    i = min(int(u), size - 2)
    return data[at + i] + (u - i) * (data[at + i + 1] - data[at + i])


@compiled
def kinematic_error(s, par, tab, data, a, b, aged):
    """Pure kinematic error and its slopes by wave-generator angle a and output angle b."""
    shift = par.lag_angle * s[LAG]
    p, p_a = periodic(data, tab.p, a - shift)
    p, p_a = p * aged, p_a * aged
    if tab.ke_gain > 0:
        g = ramp(data, tab.ke_gain, LOAD_SIZE, s[T_SLOW], LOAD_STEP)
        q, dq = periodic(data, tab.p_load, a)
        p, p_a = p + g * q, p_a + g * dq
    f, df = periodic(data, tab.p_frame, a + b)
    o, do = periodic(data, tab.p_out, b)
    if par.odd_size > 0.0:
        turn = par.odd_order * a + par.odd_phase
        p, p_a = p + par.odd_size * np.sin(turn), p_a + par.odd_size * par.odd_order * np.cos(turn)
    return p + f + o, p_a + df, df + do


@compiled
def hysteresis(s, par, tab, data, dphi):
    """Torque of the elements with memory of the deflection; moves them by dphi."""
    torque = 0.0
    if par.hysteresis == MAXWELL:
        for i in range(tab.slips):
            most = data[tab.slip_x + i]
            x = min(max(s[Z_HYST + i] + dphi, -par.slip_back * most), most)
            s[Z_HYST + i] = x
            torque += data[tab.slip_k + i] * x
    elif par.hysteresis == BOUC_WEN:
        z = s[Z_HYST] / par.bw_x
        lopsided = par.bw_beta * np.sign(dphi * z) + (1.0 - par.bw_beta) + par.bw_delta * np.sign(dphi)
        grow = 1.0 - np.abs(z) ** par.bw_n * lopsided
        s[Z_HYST] += dphi * grow
        torque += par.bw_k * s[Z_HYST]
    return torque


@compiled
def creep(s, tab, data, phi, dt):
    """Relaxing springs in parallel (standard linear solid); each follows the deflection with its own time."""
    torque = 0.0
    for i in range(tab.creeps):
        s[Z_CREEP + i] += dt / data[tab.creep_tau + i] * (phi - s[Z_CREEP + i])
        torque += data[tab.creep_k + i] * (phi - s[Z_CREEP + i])
    return torque


@compiled
def elastic(s, par, tab, data, phi, a, b, aged):
    """Torque stored by the springs and the two couples of an angle-dependent stiffness (minus dV/da, minus dV/db)."""
    k_a, dk_a = periodic(data, tab.stiff_m, a)
    k_b, dk_b = periodic(data, tab.stiff_l, b)
    torque = par.K * aged * (1.0 + k_a + k_b) * phi
    if tab.spring > 0:
        u = min(max(phi / DEFLECTION_STEP + (DEFLECTION_SIZE - 1) / 2, 0.0), DEFLECTION_SIZE - 2.0)
        i = tab.spring + int(u)
        torque += data[i] + (u - int(u)) * (data[i + 1] - data[i])
    half = 0.5 * par.K * aged * phi * phi
    return torque, -half * dk_a, -half * dk_b


@compiled
def friction_level(s, par, tab, data, noise, scale):
    """How much dry friction the motor side can give, N·m, >= 0."""
    w = s[W]
    by_angle, _ = periodic(data, tab.friction_angle, s[TH])
    by_frame, _ = periodic(data, tab.friction_frame, s[TH] + s[TL])
    level = par.T_c * (1.0 + by_angle + by_frame)
    level += ramp(data, tab.friction_forward if w >= 0 else tab.friction_backward, SPEED_SIZE, np.abs(w), SPEED_STEP)
    if tab.friction_load > 0:
        more = ramp(data, tab.friction_load, LOAD_SIZE, np.abs(s[TORQUE]), LOAD_STEP)
        level += more if s[TORQUE] * w >= 0 else more * par.back_driven
    return max(level * scale + noise, 0.0)


@compiled
def sliding(s, par, level, force, dt):
    """New motor speed under `force` and friction up to `level`; returns speed and friction torque."""
    w, inertia = s[W], par.J_m
    if par.friction == DRY:
        free = w + dt * force / inertia
        most = dt * level / inertia
        held = min(max(free, -most), most)
        return free - held, held * inertia / dt
    if par.friction == LUGRE:
        z = s[Z_FRIC]
        if np.abs(w) > 1e-12:
            end = level / par.sigma_0 * np.sign(w)
            s[Z_FRIC] = end + (z - end) * np.exp(-par.sigma_0 * np.abs(w) * dt / max(level, 1e-9))
        torque = par.sigma_0 * s[Z_FRIC] + par.sigma_1 * (s[Z_FRIC] - z) / dt
    else:
        torque = 0.0
        for i in range(2):
            part = par.share if i == 0 else 1.0 - par.share
            k = par.sigma_0 * (0.75 if i == 0 else 0.25)
            s[Z_FRIC + i] = min(max(s[Z_FRIC + i] + k * w * dt, -part * level), part * level)
            torque += s[Z_FRIC + i]
        torque += par.sigma_1 * w / (1.0 + 100.0 * w * w)  # micro-damping, gone once the motor turns
    return w + dt * (force - torque) / inertia, torque


@compiled
def dry(v, force, level, inertia, dt):
    """Velocity after dt under `force` with set-valued friction `level`; and the friction force."""
    free = v + dt * force / inertia
    most = dt * level / inertia
    held = min(max(free, -most), most)
    return free - held, held * inertia / dt
