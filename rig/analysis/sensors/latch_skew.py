"""Latch skew between channels: what of forward minus reverse grows with speed, and phases of torque against motion.

Per speed and repeat, over the same whole turns both ways (what repeats with the angle drops out):

    ½(Δ_forward − Δ_reverse) = h + (τ_odd + σ·B_ml·ω·(1 + σ/N))/K − s·ω/N      [ghorbel2001, Eqs. 5-7]

Δ = θ_m/N − θ_l of the rows, h lost motion and hysteresis, τ_odd wind-up by the friction the torque sensor sees, B_ml
what drags beside the spring, s how much later than θ_m the row's θ_l was latched. The torque's time comes from the
load's own law at the orders the gear shakes it with, τ = J_l·θ̈_l + B_l·θ̇_l, whose phase is known.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.core.quantiles import Z95
from rig.core.units import TURN
from rig.model.transmission_error import transmission_error

SETTLE = 0.5  # s at speed before a row counts: the gear's own swing, 25 Hz at 4 % damping, is over by then
STEADY = 1e-6  # of the speed: the reference runs straight
SLOWEST = 0.2  # rad/s: slower than that is no leg
K_SHARE = 0.1  # how well the stiffness of the wind-up is taken to be known, relative, 95 %
MESH_SHARE = 1 / 3  # how well the declared B_ml is: `hdrig identify` takes it to a third as well
ORDERS = (1, 2, 3, 4, 6)  # of the motor, where strain-wave gears shake their load
CLEAR = 8.0  # times its standard error an amplitude stands out, or its phase says nothing
ROUNDING = 1e-13  # of the largest value: a smaller standard error is that of arithmetic, not of a sensor


@dataclass(frozen=True)
class Leg:
    """One way at one speed; all shapes (n,), SI."""

    t: Array
    theta_m: Array
    theta_l: Array
    tau_l: Array | None

    @property
    def omega(self) -> float:
        """Mean speed of the motor, signed [rad/s]."""
        return float((self.theta_m[-1] - self.theta_m[0]) / (self.t[-1] - self.t[0]))


@dataclass(frozen=True)
class Wound:
    """What winds the gear up in proportion to the speed, as declared."""

    ratio: float
    K: float  # N·m/rad
    B_l: float  # N·m·s/rad, 0 where nobody says
    B_ml: float  # N·m·s/rad, 0 where nobody says
    sigma: int  # 1 flexspline drives the load, 0 circular spline

    def beside(self, omega: Array) -> Array:
        """rad at the output, shape of `omega` [rad/s]: by what drags beside the spring, unseen by the torque sensor."""
        return self.sigma * self.B_ml * omega * (1.0 + self.sigma / self.ratio) / self.K


@dataclass(frozen=True)
class Pair:
    """Forward and reverse over the same turns."""

    omega: float  # rad/s, of the motor, > 0
    odd: float  # rad at the output, ½(Δ_forward − Δ_reverse)
    torque: float  # N·m, the same of the torque; NaN without a sensor


@dataclass(frozen=True)
class Line:
    """The slope of a straight line through pairs, with its standard error."""

    slope: float
    u_slope: float
    dof: int


@dataclass(frozen=True)
class Late:
    """How much later than another channel one was latched [s], and the half width of its 95 % interval."""

    value: float
    half: float


def legs(t: Array, theta_m: Array, theta_l: Array, theta_ref: Array, tau_l: Array | None) -> list[Leg]:
    """The stretches in which the reference moves at one speed, less the time the loop takes to settle."""
    speed = np.diff(theta_ref) / np.diff(t)
    with np.errstate(invalid="ignore"):
        straight = (np.abs(np.diff(speed)) < STEADY * np.nanmax(np.abs(speed))) & (np.abs(speed[1:]) > SLOWEST)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], straight.astype(np.int8), [0]))))
    found = []
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        begin = int(np.searchsorted(t, t[first] + SETTLE))
        rows = slice(begin, int(last) + 1)
        if last - begin > 8 and abs(theta_ref[last] - theta_ref[begin]) > TURN:
            found.append(Leg(t[rows], theta_m[rows], theta_l[rows], None if tau_l is None else tau_l[rows]))
    return found


def pairs(found: list[Leg], ratio: float) -> list[Pair]:
    """Neighbouring legs that go over the same whole turns, one each way, at one speed."""
    out = []
    for forward, reverse in pairwise(found):
        if not (forward.omega > 0 > reverse.omega and abs(forward.omega / reverse.omega + 1) < 0.05):
            continue
        low = max(forward.theta_m[0], reverse.theta_m[-1])
        turns = int((min(forward.theta_m[-1], reverse.theta_m[0]) - low) / TURN)
        if turns >= 1:
            window = (float(low), float(low) + turns * TURN)
            odd = 0.5 * (_mean(forward, ratio, window) - _mean(reverse, ratio, window))
            torque = float("nan")
            if forward.tau_l is not None and reverse.tau_l is not None:
                torque = 0.5 * (_over(forward, forward.tau_l, window) - _over(reverse, reverse.tau_l, window))
            out.append(Pair(0.5 * (forward.omega - reverse.omega), odd, torque))
    return out


def _mean(leg: Leg, ratio: float, window: tuple[float, float]) -> float:
    return _over(leg, transmission_error(leg.theta_m, leg.theta_l, ratio), window)


def _over(leg: Leg, values: Array, window: tuple[float, float]) -> float:
    """Mean of `values` over the motor angle, not over time: a ripple of the speed must not weigh."""
    forward = leg.theta_m[-1] > leg.theta_m[0]
    theta = np.maximum.accumulate(leg.theta_m if forward else leg.theta_m[::-1])
    y = values if forward else values[::-1]
    inside = (theta > window[0]) & (theta < window[1])
    x = np.concatenate(([window[0]], theta[inside], [window[1]]))
    ends = np.interp(window, theta, y)
    return float(np.trapezoid(np.concatenate(([ends[0]], y[inside], [ends[1]])), x) / (window[1] - window[0]))


def line(x: Array, y: Array) -> Line:
    """By least squares; the standard error from the scatter about it, a bend included."""
    about = x - x.mean()
    slope = float(about @ y / (about @ about))
    rest = y - y.mean() - slope * about
    dof = max(x.size - 2, 1)
    return Line(slope, float(np.sqrt(rest @ rest / dof / (about @ about))), dof)


def load_encoder_late(found: list[Pair], wound: Wound) -> Late:
    """θ_l after θ_m. Without a torque sensor the declared B_l is taken off, and as much stands in the interval: load
    friction that grows with speed looks like B_l/K of skew, 70 µs on the paper's rig.
    """
    omega = np.array([p.omega for p in found])
    odd = np.array([p.odd for p in found])
    torque = np.array([p.torque for p in found])
    seen = bool(np.isfinite(torque).all())
    shaft = (torque if seen else wound.B_l * omega / wound.ratio) / wound.K
    beside = wound.beside(omega)
    fitted = line(omega, odd - shaft - beside)
    unsure = np.hypot(line(omega, shaft).slope * (K_SHARE if seen else 1.0), line(omega, beside).slope * MESH_SHARE)
    return Late(
        -wound.ratio * fitted.slope, wound.ratio * float(np.hypot(t95(fitted.dof) * fitted.u_slope, float(unsure)))
    )


def torque_late(found: list[Leg], odd: list[Pair], ratio: float) -> Late | None:
    """τ_l after θ_l, negative by the lag of the sensor's own filter, which is included. None: nothing shook."""
    points = [p for leg in found if leg.tau_l is not None for p in _phases(leg, leg.tau_l)]
    if len(points) < 3 or not odd:
        return None
    w, turned, u = (np.array(column) for column in zip(*[(p[0], np.angle(p[1]), p[2]) for p in points], strict=True))
    stiff = np.array([abs(p[1]) for p in points])
    J_l = float(np.sum(stiff * w**2 / u**2) / np.sum(w**4 / u**2))
    drag = line(np.array([p.omega for p in odd]) / ratio, np.array([p.torque for p in odd]))  # slope: B_l
    u = u / (stiff * w)  # s
    late = (turned + np.arctan2(drag.slope, J_l * w)) / w
    lever = 1.0 / (J_l * w**2 + drag.slope**2 / J_l)  # s per N·m·s/rad that B_l is larger
    return _by_both(late, u, lever, drag)


def _by_both(late: Array, u: Array, lever: Array, drag: Line) -> Late:
    """Delay and B_l by least squares over the points [s], B_l seen by the mean torques as well, each by its error."""
    own = max(t95(drag.dof) / Z95 * drag.u_slope, 1e-9)  # N·m·s/rad, widened for the few pairs
    rows = np.stack([np.append(1.0 / u, 0.0), np.append(-lever / u, 1.0 / own)], axis=1)
    sides = np.append(late / u, 0.0)
    inverse = np.linalg.inv(rows.T @ rows)
    found = inverse @ (rows.T @ sides)
    scatter = float(np.sqrt(np.sum((sides - rows @ found) ** 2) / (late.size - 1)))
    return Late(float(found[0]), t95(late.size - 1) * max(scatter, 1.0) * float(np.sqrt(inverse[0, 0])))


def _phases(leg: Leg, tau_l: Array) -> list[tuple[float, complex, float]]:
    """(frequency [rad/s], τ/(−θ_l) [N·m/rad] of one order, its standard error) where both stand out."""
    t, base = leg.t - leg.t[0], abs(leg.omega)
    turns = int(base * t[-1] / TURN)
    rows = t <= turns * TURN / base
    columns = [np.ones(int(rows.sum())), t[rows]]
    for n in ORDERS:
        columns += [np.cos(n * base * t[rows]), np.sin(n * base * t[rows])]
    design = np.stack(columns, axis=1)
    out = []
    (moved, u_moved), (pulled, u_pulled) = (_amplitudes(design, y[rows]) for y in (leg.theta_l, tau_l))
    for n, theta, tau in zip(ORDERS, moved, pulled, strict=True):
        if abs(theta) > CLEAR * u_moved and abs(tau) > CLEAR * u_pulled:
            size = abs(tau / theta)
            out.append(
                (n * base, complex(-tau / theta), size * float(np.hypot(u_moved / abs(theta), u_pulled / abs(tau))))
            )
    return out


def _amplitudes(design: Array, y: Array) -> tuple[list[complex], float]:
    """Complex amplitudes of the orders, and the standard error of one part of them, from what the fit leaves."""
    found, *_ = np.linalg.lstsq(design, y, rcond=None)
    rest = y - design @ found
    u = float(np.sqrt(rest @ rest / max(y.size - found.size, 1) * 2.0 / y.size))
    u = max(u, ROUNDING * float(np.abs(y).max()))
    return [complex(a, -b) for a, b in zip(found[2::2], found[3::2], strict=True)], u
