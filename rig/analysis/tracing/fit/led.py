"""A motor led along a motion, and the load that follows it: the fitted model integrated      [ghorbel2001, Eqs. 6-7]

    J_l·θ̈_l = T + τ_ext − B_l·ω_l − τ_cl·sgn ω_m − l,   T = K·δ + B_sp·δ̇,   δ = θ_m/N − θ̃_p − a − θ_l

with the effects' wind-up and kinematic error a and load torque l.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.learnt import known_of
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.runs.smoothing import flat
from rig.model.effect import Array, Known, Signals
from rig.model.memory import marched
from rig.model.waves import sums

FINE: Final = 8  # steps between two rows of 4 ms: order 15 at 500 rpm then has 16 a period


@dataclass(frozen=True)
class Model:
    """What is needed of a fit: the gear, its load's friction, the mesh's drag over K, terms with coefficients."""

    gear: Known
    B_l: float  # N·m·s/rad
    tau_cl: float  # N·m
    mesh: float  # s
    terms: tuple[tuple[Term, Array], ...]

    @property
    def decay(self) -> float:
        """Time constant of the gear's resonance, s."""
        return 2.0 * self.gear.J_l / max(self.B_l + self.gear.B_sp, 1e-9)


def model_of(s: Solution) -> Model:
    """The model a fit stands for; what it cannot say is as believed before."""
    d, v = s.design, s.values
    gear = known_of(v, d.eq.runs[0].gear)
    gear = replace(gear, B_sp=max(gear.B_sp, 0.0))
    terms = tuple((term, s.x[d.place(i)]) for i, term in enumerate(d.terms))
    return Model(gear, max(v["B_l"], 0.0), max(v["tau_cl"], 0.0), v["mesh"], terms)


@dataclass(frozen=True)
class Led:
    """The motor's motion on the fine grid, (m,): e = θ_m/N − θ̃_p and its derivatives by time."""

    e: Array
    rate: Array
    acceleration: Array


def lead(s: Signals, model: Model, read_m: Array) -> Led:
    """The motor turns as it was read in `s`, less what the reading has too much, `read_m` (n,) rad."""
    from scipy.interpolate import CubicSpline  # here and below: a tenth of a second before anything is read

    spline = CubicSpline(np.arange(s.t.size), s.theta_m - read_m)
    fine = np.arange((s.t.size - 1) * FINE + 1) / FINE
    theta, omega, alpha = spline(fine), spline(fine, 1) / s.dt, spline(fine, 2) / s.dt**2
    p = model.gear.kinematic_error
    value, slope, bend = sums(p, theta, 0, 1, 2)
    lever = 1.0 / s.ratio - slope
    return Led(theta / s.ratio - value, omega * lever, alpha * lever - omega**2 * bend)


def follow(s: Signals, model: Model, led: Led, wind_up: Array, load: Array) -> Signals:
    """The signals of a load that follows, under `wind_up` [rad] and `load` [N·m] of the effects, (n,) both; motor, time
    and weight are those of `s`."""
    g, h = model.gear, s.dt / FINE
    damping = g.B_sp + model.B_l
    grid, fine = np.arange(s.t.size), np.arange(led.e.size) / FINE
    away, rubs = np.interp(fine, grid, wind_up), np.interp(fine, grid, load + model.tau_cl * s.way)
    push = g.J_l * led.acceleration + model.B_l * led.rate - s.tau_ext[0] + rubs
    phi = _filtered([1.0], [g.J_l, damping, g.K], h, push)  # e − θ_l, wound up by the inertia
    phi = phi + _filtered([g.B_sp, g.K], [g.J_l, damping, g.K], h, away)
    theta = led.e - phi
    twist = phi - away
    torque = g.K * twist + g.B_sp * np.gradient(twist, h)
    omega = np.gradient(theta, h)
    alpha = np.gradient(omega, h)
    here = slice(None, None, FINE)
    read = flat(torque[here])  # as the effects were fitted
    return replace(
        s,
        theta_l=theta[here],
        omega_l=omega[here],
        alpha_l=alpha[here],
        torque=read,
        tau_l=read,
        torque_rate=np.gradient(torque, h)[here],
        gear=g,
        cut=None,  # what was measured before is no past of this motion
    )


def rung(torque: Array, dt: float, model: Model) -> Array:
    """θ̃ (n,) that a torque (n,) on the load every `dt` s makes by itself, while the motor is led: rad, the gear's
    resonance in it, whose amplification no reading takes back."""
    g = model.gear
    return -_filtered([1.0], [g.J_l, g.B_sp + model.B_l, g.K], dt, torque)


def _filtered(top: Sequence[float], bottom: Sequence[float], h: float, x: Array) -> Array:
    """`x` (m,) every h s, straight between, through (top_1·s + top_0)/(J·s² + d·s + K), begun in balance with x[0];
    exact."""
    from scipy.linalg import expm

    inertia, damping, stiffness = bottom
    matrix = np.zeros((4, 4))  # of the state, of x and of its slope
    matrix[0, 1] = matrix[2, 3] = 1.0
    matrix[1, :3] = np.array([-stiffness, -damping, 1.0]) / inertia
    over = expm(matrix * h)[:2]
    state = marched(over[:, :2], over[:, 2] - over[:, 3] / h, over[:, 3] / h, x, np.array([x[0] / stiffness, 0.0]))
    return np.asarray(state @ np.array([*reversed(top), 0.0])[:2])
