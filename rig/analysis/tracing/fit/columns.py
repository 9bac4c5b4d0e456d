"""Response and baseline columns of each equation along one piece of a run: see channels.py."""

from __future__ import annotations

import numpy as np

from rig.analysis.tracing.fit.channels import ORDERS, SERIES
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.model.effect import Array, Signals
from rig.model.waves import powers

Columns = tuple[Array, dict[str, Array]]
Has = frozenset[str]


def angle(s: Signals, f: Smoother, has: Has) -> Columns:
    y = f(s.theta_m / s.ratio - s.theta_l)
    columns = dict(zip(SERIES, f(series(s.theta_m)).T, strict=True))
    columns |= {"compliance": f(s.tau_l), "damping": f(s.tau_l, 1), "damping_2": f(s.tau_l, 2)}
    columns |= {"mesh": f(s.theta_m, 1), "c_0": np.ones_like(y)}
    if "tau_l" not in has:  # what the load's bearings take is missing in T
        columns |= {"tau_cl": f(s.way) / s.gear.K}
        if "t" in has:  # else, beside the rate of the motor's angle, it would be that of θ̃ itself
            columns |= {"B_l": f(s.theta_l, 1) / s.gear.K}
    return y, columns


def held(s: Signals, f: Smoother, has: Has) -> Columns:
    """A of an output that is locked, without the wind-up: what its encoder reads, which should be nothing."""
    y = f(-s.theta_l)
    return y, {"c_0": np.ones_like(y)}


def motor(s: Signals, f: Smoother, has: Has) -> Columns:
    y = f(s.tau_m - s.tau_l / s.ratio)
    lever = f(-s.tau_l[:, None] * slopes(s.theta_m))
    columns = dict(zip(SERIES, lever.T, strict=True))
    if "theta_m" not in has:
        columns = _with_angle(columns, s, f, has, s.gear.J_m * s.ratio)
    elif "theta_l" not in has and "tau_l" not in has:
        columns = _with_angle(columns, s, f, has, -s.gear.J_l / s.ratio)
    theta = s.theta_m if "theta_m" in has else s.theta_l * s.ratio  # what it is ahead by has columns of its own
    columns |= {"J_m": f(theta, 2), "B_m": f(theta, 1), "tau_c": f(s.way), "tau_0": np.ones_like(y)}
    if "tau_l" not in has and "theta_l" in has:  # what the load's bearings take is missing in T
        columns |= {"B_l": f(s.omega_l * s.lever), "tau_cl": f(s.way * s.lever)}
    return y, columns


def wound(y: Array, columns: dict[str, Array], s: Signals, f: Smoother) -> Columns:
    """M where T is K·(θ̃ − θ̃_p): θ̃_p as known is put back, and has its own columns. The load rests: its bearings
    take nothing."""
    spring = np.full(s.t.size, s.gear.K) if s.stiffness is None else s.stiffness
    spring = spring / s.ratio
    waves = dict(zip(SERIES, -f(spring[:, None] * series(s.theta_m)).T, strict=True))
    columns = {name: column for name, column in columns.items() if name not in ("B_l", "tau_cl")}
    return y - f(spring * s.series_value), columns | {name: columns[name] + wave for name, wave in waves.items()}


def load(s: Signals, f: Smoother, has: Has) -> Columns:
    y = f(s.tau_l + s.tau_ext)
    columns = {"J_l": f(s.theta_l, 2), "B_l": f(s.theta_l, 1), "tau_cl": f(s.way), "tau_l0": np.ones_like(y)}
    if "theta_l" not in has:
        columns = _with_angle(columns, s, f, has, -s.gear.J_l)
    columns |= {"lag": -f(s.tau_l, 1)}
    return y, columns


def _with_angle(columns: dict[str, Array], s: Signals, f: Smoother, has: Has, inertia: float) -> dict[str, Array]:
    """With inertia·d²θ̃/dt² of A, in the place of an angle that was not measured."""
    waves = dict(zip(SERIES, inertia * f(series(s.theta_m), 2).T, strict=True))
    out = columns | {name: columns[name] + wave if name in columns else wave for name, wave in waves.items()}
    if "tau_l" not in has:
        return out
    return out | {"compliance": inertia * f(s.tau_l, 2), "damping": inertia * f(s.tau_l, 3)}


def series(theta: Array) -> Array:
    """cos nθ, sin nθ in turn, n = 1..15, shape (n, 30)."""
    return powers(theta, ORDERS)


def slopes(theta: Array) -> Array:
    """d/dθ of `series`, shape (n, 30)."""
    return powers(theta, ORDERS, slopes=True)
