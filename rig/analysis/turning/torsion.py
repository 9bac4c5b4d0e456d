"""Torsion against shaft torque while the gear turns: the stiffness it suggests, and whether the run can say so."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.motion.strokes import turning_points
from rig.analysis.orders.lines import Line, fit_lines
from rig.core.units import ARCSEC, TURN

MOVES = 2.0  # scatter of the torque's turn means over its scatter within a turn: below, the torque does not move
STEADY = 0.10  # of the sweep's speed: outside, the shaft torque holds inertia, and friction that changes with speed
LOAD_HARMONICS = 8  # per output turn
BLOCKS = 12  # the sweep is left out one twelfth at a time to see how far the slope depends on where it was taken
SEPARABLE = 10.0  # variance inflation: above, the torque is nearly a function of the output angle alone


@dataclass(frozen=True)
class Torsion:
    """One sweep's torsion against torque. Angles rad at the output, torque N·m, stiffness N·m/rad."""

    stiffness: float  # 1/slope of θ̃ against torque, nothing else in the fit
    interval: tuple[float, float]
    stiffness_beside: float  # the same with the output harmonics free beside it
    inflation: float  # how much the output harmonics can stand in for the torque (variance inflation)
    span: float  # rad, largest minus smallest θ̃ of the whole sweep
    remainder: float  # rad, rms after torque and output harmonics
    lines: list[Line]  # of the remainder, rad, at the orders asked for
    turns: float  # motor turns of the steady part
    torque: Array
    angle: Array  # θ̃ less its mean
    steady: slice

    @property
    def separable(self) -> bool:
        return self.inflation < SEPARABLE


def longest_sweep(motion: Motion) -> slice:
    """Rows of the longest motion in one direction, reversals by a quarter turn or more."""
    theta = motion.theta_m
    pivots = turning_points(theta, TURN / 4)
    if len(pivots) < 2:
        return slice(0, theta.size)
    k = int(np.argmax(np.abs(np.diff(theta[pivots]))))
    return slice(pivots[k], pivots[k + 1] + 1)


def steady_part(motion: Motion, sweep: slice) -> slice:
    """The part of the sweep between the first and the last turn whose mean speed is within 10 % of the usual.

    Whole turns are taken, so angle-locked ripple and jitter of single time stamps do not matter. Without time: all.
    """
    if motion.t is None:
        return sweep
    theta, t = motion.theta_m[sweep], motion.t[sweep]
    progress = np.maximum.accumulate(np.abs(theta - theta[0]))
    marks = np.searchsorted(progress, np.arange(0.0, progress[-1], TURN))
    if marks.size < 4:
        return sweep
    speed = np.diff(progress[marks]) / np.diff(t[marks])
    good = np.flatnonzero(np.abs(speed / np.median(speed) - 1.0) <= STEADY)
    if not good.size:  # speeds so uneven that their middle is none of them, as around a hole
        return sweep
    return slice(sweep.start + int(marks[good[0]]), sweep.start + int(marks[good[-1] + 1]))


def torque_moves(motion: Motion, tau: Array, sweep: slice) -> bool:
    """Whether the shaft torque changes over the sweep by more than it does within a motor turn."""
    theta, tau = motion.theta_m[sweep], tau[sweep]
    turn = (np.abs(theta - theta[0]) / TURN).astype(np.int64)
    rows = np.bincount(turn)[:-1]  # the last turn is not whole
    if rows.size < 3:
        return False
    means = np.bincount(turn, tau)[:-1] / np.maximum(rows, 1)
    within = float(np.std(tau[turn < rows.size] - means[turn[turn < rows.size]]))
    return float(np.std(means)) > MOVES * max(within, 1e-12)


def _line(x: Array, y: Array) -> float:
    x = x - x.mean()
    return float(x @ (y - y.mean())) / float(x @ x)


def _half_width(tau: Array, angle: Array) -> float:
    """Half the 95 % interval of that slope, by a jackknife over the twelfths."""
    edges = np.linspace(0, tau.size, BLOCKS + 1).astype(int)
    left = [_line(np.delete(tau, s), np.delete(angle, s)) for s in map(slice, edges[:-1], edges[1:])]
    return t95(BLOCKS - 1) * float(np.sqrt((BLOCKS - 1) / BLOCKS * np.sum((np.array(left) - np.mean(left)) ** 2)))


def output_harmonics(theta_l: Array, count: int = LOAD_HARMONICS) -> Array:
    """Constant, cos kθ_l and sin kθ_l, k = 1..count: (n, 1 + 2·count)."""
    angle = np.multiply.outer(theta_l, np.arange(1, count + 1))
    return np.concatenate((np.ones((theta_l.size, 1)), np.cos(angle), np.sin(angle)), axis=1)


def _beside_harmonics(tau: Array, angle: Array, theta_l: Array) -> tuple[float, float, Array]:
    """The slope with the output harmonics free beside it, the variance inflation by them, and what is left (n,)."""
    base = output_harmonics(theta_l)
    design = np.column_stack((tau, base))
    scale = np.sqrt(np.mean(design**2, axis=0))
    c: Array = np.linalg.lstsq(design / scale, angle, rcond=1e-10)[0] / scale
    alone = tau - base @ np.linalg.lstsq(base, tau, rcond=1e-10)[0]
    inflation = float(np.var(tau)) / max(float(np.var(alone)), 1e-300)
    return float(c[0]), inflation, angle - design @ c


def torsion(motion: Motion, tau_l: Array, orders: list[float]) -> Torsion | None:
    """Slope of θ̃ against `tau_l` [N·m, positive when the gear drives the load forward], over the longest sweep.

    τ = K·(θ_m/N − θ_l) at rest in the mean [ghorbel2001, Eqs. 2, 4], so the slope is +1/K. The interval is a
    jackknife over twelfths of the sweep: neighbouring rows are far from independent, twelfths nearly so.
    None when the torque does not move, or there is no load angle.
    """
    if motion.theta_l is None:
        return None
    sweep = longest_sweep(motion)
    if sweep.stop - sweep.start < 50 * BLOCKS:
        return None
    steady = steady_part(motion, sweep)
    n = steady.stop - steady.start
    if n < 50 * BLOCKS or not torque_moves(motion, tau_l, steady):
        return None
    error = motion.error_arcsec(sweep.start, sweep.stop) * ARCSEC
    theta_m, theta_l, tau = motion.theta_m[steady], motion.theta_l[steady], tau_l[steady]
    angle = error[steady.start - sweep.start : steady.stop - sweep.start]
    angle = angle - angle.mean()
    slope, half = _line(tau, angle), _half_width(tau, angle)
    low, high = slope - half, slope + half

    beside, inflation, rest = _beside_harmonics(tau, angle, theta_l)
    # each order by itself: neighbours closer than the span resolves would trade amplitude in a joint fit
    lines = [fit_lines(theta_m, rest, [order])[0] for order in orders]
    return Torsion(
        stiffness=1.0 / slope,
        interval=(1.0 / high, 1.0 / low) if low * high > 0 else (float("nan"), float("nan")),
        stiffness_beside=1.0 / beside,
        inflation=inflation,
        span=float(np.ptp(error)),
        remainder=float(np.std(rest)),
        lines=lines,
        turns=float(abs(theta_m[-1] - theta_m[0])) / TURN,
        torque=tau,
        angle=angle,
        steady=steady,
    )
