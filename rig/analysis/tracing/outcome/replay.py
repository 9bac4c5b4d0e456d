"""The kinematic error the whole model makes when its motor is led along a run's motion      [ghorbel2001, Fig. 11]

Nothing of the load side is read: load angle and shaft torque are simulated, and the effects get the simulated ones.

    J_l·θ̈_l = T + τ_ext − B_l·ω_l − τ_cl·sgn ω_m − l,   T = K·δ + B_sp·δ̇,   δ = θ_m/N − θ̃_p − a − θ_l

with the effects' wind-up and kinematic error a and load torque l. What they make of the torque is found by turns: the
motion under the last a and l, then a and l of that motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import known_of
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.smoothing import flat
from rig.model.effect import Array, Known, Port, Signals
from rig.model.memory import marched
from rig.model.waves import sums

FINE: Final = 8  # steps between two rows of 4 ms: order 15 at 500 rpm then has 16 a period
SPAN: Final = 8.0  # s of a run: a turn of the slowest motor and more, and quick
TURNS: Final = 25  # of motion and effects, at most
KEPT: Final = 8  # turns whose mixture makes the next
SETTLED: Final = 2e-6  # rad, the worst row: 0.4 arcsec, a tenth of what is left after
GONE: Final = 6.0  # time constants after which the start is forgotten, to a four-hundredth


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
    gear = known_of(v, d.eq.runs[0].pieces[0].gear)
    gear = replace(gear, B_sp=max(gear.B_sp, 0.0))
    terms = tuple((term, s.x[d.place(i)]) for i, term in enumerate(d.terms))
    return Model(gear, max(v["B_l"], 0.0), max(v["tau_cl"], 0.0), v["mesh"], terms)


def replayed(run: Recording, model: Model) -> Array | None:
    """θ̃ (rows,) on the smoothed rows of the run's first piece, SPAN s of it at most; None where the turns of motion and
    effects do not settle."""
    piece = shown(run)
    found = _kinematic_error(piece, model)
    return None if found is None else run.smoother(found)


def shown(run: Recording) -> Signals:
    """The part of a run that is simulated."""
    first = run.pieces[0]
    return first.part(slice(0, round(SPAN / first.dt)))


def _kinematic_error(s: Signals, model: Model) -> Array | None:
    """θ̃ as it would be read, on the grid of the piece, (n,)."""
    n, stiff = s.t.size, model.gear.K
    led, x = _led(s, model, np.zeros(n)), np.zeros(2 * n)
    read_m = np.zeros(n)
    mixed = Anderson()
    for _ in range(TURNS):
        moved = _moved(s, model, led, x[:n], stiff * x[n:])
        wind_up, load, turned, read_l = _acting(moved, model)
        if np.any(turned != read_m):
            read_m, led = turned, _led(s, model, turned)
        new = np.concatenate([wind_up, load / stiff])
        if np.max(np.abs(new - x)) < SETTLED:
            return np.asarray(s.theta_m / s.ratio - moved.theta_l - read_l)
        x = mixed.next(x, new)
    return None


class Anderson:
    """Fixed point x = g(x) from the last few turns: the mixture of them that misses least      [anderson1965]"""

    def __init__(self) -> None:
        self.seen: list[tuple[Array, Array]] = []

    def next(self, x: Array, g: Array) -> Array:
        """The x to try after g(x) = `g`."""
        self.seen = [*self.seen, (x, g - x)][-KEPT:]
        last, miss = self.seen[-1]
        if len(self.seen) == 1:
            return g
        moves = np.stack([last - a for a, _ in self.seen[:-1]], 1)
        misses = np.stack([miss - m for _, m in self.seen[:-1]], 1)
        weights = np.linalg.lstsq(misses, miss, rcond=1e-10)[0]
        return np.asarray(last + miss - (moves + misses) @ weights)


@dataclass(frozen=True)
class _Led:
    """The motor's motion on the fine grid, (m,): e = θ_m/N − θ̃_p and its derivatives by time."""

    e: Array
    rate: Array
    acceleration: Array


def _led(s: Signals, model: Model, read_m: Array) -> _Led:
    from scipy.interpolate import CubicSpline  # here and below: a tenth of a second before anything is read

    spline = CubicSpline(np.arange(s.t.size), s.theta_m - read_m)
    fine = np.arange((s.t.size - 1) * FINE + 1) / FINE
    theta, omega, alpha = spline(fine), spline(fine, 1) / s.dt, spline(fine, 2) / s.dt**2
    p = model.gear.kinematic_error
    value, slope, bend = sums(p, theta, 0, 1, 2)
    lever = 1.0 / s.ratio - slope
    return _Led(theta / s.ratio - value, omega * lever, alpha * lever - omega**2 * bend)


def _moved(s: Signals, model: Model, led: _Led, wind_up: Array, load: Array) -> Signals:
    """The signals of a load that follows; motor, time and weight are the run's own."""
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
        jerk_l=np.gradient(alpha, h)[here],
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


def _acting(s: Signals, model: Model) -> tuple[Array, Array, Array, Array]:
    """Wind-up with kinematic error [rad], load torque [N·m], and what θ_m and θ_l read too much, (n,)."""
    total = {port: np.zeros(s.t.size) for port in PORTS}
    total[Port.WIND_UP] = model.mesh * s.omega_m
    for term, coefficients in model.terms:
        for port, columns in term.effect.columns(s, term.shape).items():
            if port in total:
                total[port] = total[port] + columns @ coefficients
    both = total[Port.WIND_UP] + total[Port.KINEMATIC_ERROR]
    return both, total[Port.LOAD_TORQUE], total[Port.READS_THETA_M], total[Port.READS_THETA_L]


PORTS: Final = (Port.WIND_UP, Port.KINEMATIC_ERROR, Port.LOAD_TORQUE, Port.READS_THETA_M, Port.READS_THETA_L)
