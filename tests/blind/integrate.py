"""One step of the plant, and a run of it under its controller, compiled."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tests.blind.kernel import (
    COUPLING,
    DISC,
    HEAT,
    HOUSING,
    LAG,
    RIGID,
    SENSOR_SHAFT,
    T_SLOW,
    TH,
    TL,
    TORQUE,
    VX,
    W_DISS,
    W_IN,
    WL,
    W,
    X,
    compiled,
    creep,
    dry,
    elastic,
    friction_level,
    hysteresis,
    kinematic_error,
    periodic,
    sliding,
)

TICK = 1e-3  # s, period of controller and of the raw record
HOLD_ANGLE, HOLD_TORQUE = 0, 1


class Drive(NamedTuple):
    """The controller of a run: position PID on the counted angle, or speed trim then constant torque."""

    kind: int
    Kp: float
    Ki: float
    Kd: float
    smooth: float  # share of the new speed estimate taken per tick
    counts: float  # motor encoder, 1/rev
    limit: float  # N·m
    trim_ticks: int
    speed: float  # rad/s


@compiled
def moved(s, par, tab):
    """Angles and speeds seen by the mesh: a, va (wave generator), b, vb (gear output in the housing's frame)."""
    if par.extra == COUPLING:
        return s[X], s[VX], s[TL], s[WL]
    if par.extra == HOUSING:
        return s[TH], s[W], s[TL] - s[X], s[WL] - s[VX]
    if par.extra == SENSOR_SHAFT:
        return s[TH], s[W], s[X], s[VX]
    return s[TH], s[W], s[TL], s[WL]


@compiled
def drift(s, dt, locked):
    s[TH] += dt * s[W]
    s[X] += dt * s[VX]
    if locked == 0:
        s[TL] += dt * s[WL]


@compiled
def shares(par, on_a, on_b, shaft):
    """Who feels the mesh: forces on motor, load and extra body. `shaft` is the torque k x of the extra spring."""
    if par.extra == COUPLING:
        return -shaft, on_b, on_a + shaft
    if par.extra == HOUSING:
        return on_a, on_b, -on_b - shaft
    if par.extra == SENSOR_SHAFT:
        return on_a, shaft, on_b - shaft
    if par.extra == DISC:
        return on_a, on_b + shaft, -shaft
    return on_a, on_b, 0.0


@compiled
def extra_spring(s, par):
    """Torque of the spring that carries the extra body, and the part of it that dissipates, by relative speed."""
    if par.extra == RIGID:
        return 0.0, 0.0
    if par.extra == COUPLING:
        d, v = s[TH] - s[X], s[W] - s[VX]
    elif par.extra == HOUSING:
        d, v = s[X], s[VX]
    else:
        d, v = s[X] - s[TL], s[VX] - s[WL]
    lost = par.c_x * v
    return par.k_x * d + lost, lost * v


@compiled
def step(s, par, tab, data, tau, on_load, noise_m, noise_l, scale_c, scale_v, age, dt):
    """Advance the state by dt under motor torque `tau` and load torque `on_load`."""
    drift(s, 0.5 * dt, par.locked)
    a, va, b, vb = moved(s, par, tab)
    aged = 1.0 + par.ke_aging * age
    p, p_a, p_b = kinematic_error(s, par, tab, data, a, b, aged)
    phi = b - a / par.N + p
    rate = vb - va / par.N + p_a * va + p_b * vb
    spring, couple_a, couple_b = elastic(s, par, tab, data, phi, a, b, 1.0 + par.aging * age)
    lossy = hysteresis(s, par, tab, data, rate * dt) + creep(s, tab, data, phi, dt) + par.B_sp * rate
    mesh = spring + lossy
    shaft, shaft_loss = extra_spring(s, par)
    on_a, on_b = mesh * (1.0 / par.N - p_a) + couple_a, -mesh * (1.0 + p_b) + couple_b
    f_m, f_l, f_x = shares(par, on_a, on_b, shaft)
    tau = tau * (1.0 + periodic(data, tab.ripple, s[TH])[0]) + periodic(data, tab.cogging, s[TH])[0]
    on_load = on_load * (1.0 + periodic(data, tab.pulley, s[TL])[0]) + periodic(data, tab.on_load, s[TL])[0]
    rel = par.B_ml * (s[W] + s[WL])
    drag_m, drag_l = par.B_m * scale_v * s[W] + rel, par.B_l * s[WL] + rel
    level = friction_level(s, par, tab, data, noise_m, scale_c)
    w, rub = sliding(s, par, level, f_m + tau - drag_m, dt)
    wl, rub_l = 0.0, 0.0
    if par.locked == 0:
        wl, rub_l = dry(s[WL], f_l + on_load - drag_l, max(par.T_l + noise_l, 0.0), par.J_l, dt)
    vx, rub_x = 0.0, 0.0
    if par.extra != RIGID:
        vx, rub_x = dry(s[VX], f_x, par.dry_x, par.J_x, dt)
    wm, wlm, wxm = 0.5 * (w + s[W]), 0.5 * (wl + s[WL]), 0.5 * (vx + s[VX])
    s[W_IN] += dt * (tau * wm + on_load * wlm)
    s[W_DISS] += dt * ((rub + drag_m) * wm + (rub_l + drag_l) * wlm + rub_x * wxm + lossy * rate + shaft_loss)
    s[HEAT] += dt * ((rub + drag_m) * wm - s[HEAT] / par.heat_tau)
    s[W], s[WL], s[VX] = w, wl, vx
    s[TORQUE] = shaft if par.extra == SENSOR_SHAFT else -mesh
    s[T_SLOW] += min(dt / par.t_slow, 1.0) * (np.abs(mesh) - s[T_SLOW])
    s[LAG] = min(max(s[LAG] + dt * w / par.lag_scale, -1.0), 1.0)
    drift(s, 0.5 * dt, par.locked)


@compiled
def warmth(s, par, t):
    """Factors of dry and viscous friction at campaign time t: warm-up by the clock, and heat made by rubbing."""
    fade = par.warm_share * np.exp(-t / par.warm_tau_1) + (1.0 - par.warm_share) * np.exp(-t / par.warm_tau_2)
    if par.warm_root:
        fade = 1.0 / np.sqrt(1.0 + t / par.warm_tau_1)
    heated = np.exp(-par.heat_gain * s[HEAT])
    return (1.0 + par.warm_c * fade) * heated, (1.0 + par.warm_v * fade) * heated


@compiled
def delivered(tau, memory, par, tab, data):
    """Torque the motor really gives for a reported `tau`: dead zone and magnetic play."""
    out = tau
    if par.dead_zone > 0.0:
        out = np.sign(tau) * max(np.abs(tau) - par.dead_zone, 0.0)
    for i in range(tab.plays):
        width = data[tab.play_x + i]
        memory[i] = min(max(memory[i], tau - width), tau + width)
        out += data[tab.play_k + i] * (memory[i] - tau)
    return out


@compiled
def reading(s, tab, data, drive, offset):
    """What the motor encoder counts, rad."""
    q = 2.0 * np.pi / drive.counts
    return np.floor((s[TH] + periodic(data, tab.encoder_m, s[TH])[0] + offset) / q) * q


@compiled
def command(s, c, drive, tab, data, k, ref, offset):
    """Torque command of tick k. c: integral, error rate, last error, sum and count of the trim."""
    if drive.kind == HOLD_TORQUE:
        error = drive.speed - s[W]
        c[0] += drive.Ki * error * TICK
        if k < drive.trim_ticks:
            if k >= drive.trim_ticks // 2:
                c[3] += c[0]
                c[4] += 1.0
            return drive.Kp * error + c[0]
        c[0] = c[3] / max(c[4], 1.0)
        return np.round(c[0] / 5e-4) * 5e-4  # the drive takes torque in steps of 0.5 mN·m
    angle = reading(s, tab, data, drive, offset)
    error = ref - angle
    c[1] += drive.smooth * ((error - c[2]) / TICK - c[1])
    c[2] = error
    u = drive.Kp * error + c[0] + drive.Kd * c[1]
    if np.abs(u) < drive.limit:
        c[0] += drive.Ki * error * TICK
    return min(max(u, -drive.limit), drive.limit)


@compiled
def run(s, par, tab, data, drive, ref, on_load, noise_m, noise_l, offset, t_0, guess, inner, out, play):
    """Simulate len(ref) ticks; `out` (n, 4) gets theta_m, theta_l, tau_l and tau_m per tick.

    Every array of length n is given per tick; s and play are changed in place.
    """
    c = np.zeros(5)
    if drive.kind == HOLD_TORQUE:
        c[0] = guess
    dt = TICK / inner
    for k in range(ref.shape[0]):
        t = t_0 + k * TICK
        tau = command(s, c, drive, tab, data, k, ref[k], offset[k])
        scale_c, scale_v = warmth(s, par, t)
        age = t / par.aging_tau
        out[k, 0], out[k, 1], out[k, 3] = s[TH], s[TL], tau
        half_a_step_ago = s[TORQUE]
        true = delivered(tau, play, par, tab, data)
        for i in range(inner):
            step(s, par, tab, data, true, on_load[k], noise_m[k], noise_l[k], scale_c, scale_v, age, dt)
            if i == 0:  # the step knows the torque at its middle: the tick lies between two of them
                out[k, 2] = 0.5 * (half_a_step_ago + s[TORQUE])
