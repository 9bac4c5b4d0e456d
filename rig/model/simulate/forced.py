"""The load under a known motion of the motor: linear but for its dry friction, so propagated exactly piece by piece."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import expm

from rig.model.gear import Gear
from rig.model.simulate.waveform import Array

FINE = 8  # pieces between two rows, across which the motor drives the spring along a straight line


def under_motion(gear: Gear, t: Array, theta_m: Array, tau_ext: float = 0.0, theta_l: float | None = None) -> Array:
    """θ_l [rad] at times `t` [s, rising] while the motor goes through `theta_m` [rad]; all (n,).

    J_l·θ̈_l + (B_l + B_sp + σ²·B_ml)·θ̇_l + K·θ_l = K·e + B_sp·ė − σ·B_ml·ω_m + τ_ext − F_l,  e = θ_m/N − θ̃_p
    [ghorbel2001, Eq. 7]. Between rows the motor follows a cubic spline; each row is cut in eight pieces with a straight
    right-hand side, over which the load is propagated exactly. `theta_l` is where it begins (default: spring relaxed),
    with the speed the gear gives it.
    """
    ratio, series = gear.ratio, gear.kinematic_error
    spline = CubicSpline(t, theta_m)
    fine = np.append((t[:-1, None] + np.diff(t)[:, None] * np.arange(FINE) / FINE).ravel(), t[-1])
    motor, omega = spline(fine), spline(fine, 1)
    slope = series.slope(motor)
    e, e_rate = motor / ratio - series.value(motor), omega * (1.0 / ratio - slope)
    drive = gear.K * e + gear.B_sp * e_rate - gear.sigma * gear.B_ml * omega + tau_ext
    start = np.array([e[0] if theta_l is None else theta_l, e_rate[0]])
    return _propagate(gear, fine, drive, start)[::FINE]


def _propagate(gear: Gear, t: Array, drive: Array, start: Array) -> Array:
    """Angles at `t` under `drive` [N·m, straight between times]."""
    matrix = np.zeros((4, 4))
    matrix[0, 1] = 1.0
    matrix[1] = [-gear.K, -(gear.B_l + gear.B_sp + gear.sigma**2 * gear.B_ml), 1.0, 0.0]
    matrix[1] /= gear.J_l
    matrix[2, 3] = 1.0
    known: dict[float, Array] = {}
    out = np.empty(t.size)
    x, v = float(start[0]), float(start[1])
    out[0] = x
    for i, h in enumerate(np.diff(t).tolist()):
        key = round(h, 12)
        if key not in known:
            known[key] = expm(matrix * h)[:2]
        step = known[key]
        held = abs(drive[i] - gear.K * x) <= gear.F_cl and v == 0.0
        if held:
            out[i + 1] = x
            continue
        way = np.sign(v) if v != 0.0 else np.sign(drive[i] - gear.K * x)
        force, rate = drive[i] - way * gear.F_cl, (drive[i + 1] - drive[i]) / h
        x_next = float(step[0] @ (x, v, force, rate))
        v_next = float(step[1] @ (x, v, force, rate))
        x, v = x_next, (0.0 if way * v_next < 0.0 else v_next)  # friction ends a motion, it does not turn it round
        out[i + 1] = x
    return out
