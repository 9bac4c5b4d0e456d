"""The floor: what differs between two runs of the same condition at the same motor angle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.common_orders import without_common_orders
from rig.analysis.tracing.runs.strokes import strokes
from rig.analysis.tracing.thresholds import FLOOR_LEAST, UNCORRELATED
from rig.model.effect import Array

WHOLE = 1e-9  # of a ratio: the teeth of a strain-wave gear make it a whole number, or far from one
OVERLAP = 25  # rows
HOLE = 10.0  # usual distances between rows: further apart, there is nothing between them


@dataclass(frozen=True)
class Scatter:
    """Differences of one pair in one channel, as RMS of a single run, and the autocorrelation of its rows."""

    pair: tuple[int, int]
    rms: float
    rows: int
    offset: float  # difference of the two means over sqrt 2
    rho: Array
    freedom: float  # independent parts the RMS is made of: a gain that is never twice the same is one
    swollen: float = 1.0  # by how much larger it was with what goes slowly, which was no noise


def compare(theta_a: Array, e_a: Array, theta_b: Array, e_b: Array) -> Array:
    """Differences of two residuals at equal motor angle, stroke by stroke, as if of one run; (n,)."""
    both = without_common_orders(np.concatenate([theta_a, theta_b]), np.concatenate([e_a, e_b]))
    e_a, e_b = both[: e_a.size], both[e_a.size :]
    first, second = strokes(theta_a), strokes(theta_b)

    def differ(a: slice, b: slice) -> Array:
        return _differences(theta_a, e_a, a, theta_b, e_b, b)

    parts = [differ(a, b) for a, b in zip(first, second, strict=False)]
    if not any(part.size for part in parts):  # triangles that begin at another angle, or the other way
        parts = [max([differ(a, b) for b in second], key=lambda part: part.size) for a in first if second]
    d = np.concatenate([np.zeros(0), *parts])
    if not d.size:
        return d
    rho = float(np.clip(d[1:] @ d[:-1] / max(d @ d, 1e-300), 0.0, 1.0))
    # interpolation between two rows of correlation rho leaves 2/3 + rho/3 of their variance
    return np.asarray(d / np.sqrt(1 + 2 / 3 + rho / 3))


def _differences(theta_a: Array, e_a: Array, a: slice, theta_b: Array, e_b: Array, b: slice) -> Array:
    """Of one stroke and another the same way, where they overlap by more than a few rows; else none."""
    sign = np.sign(theta_b[b][-1] - theta_b[b][0])
    if sign != np.sign(theta_a[a][-1] - theta_a[a][0]):
        return np.zeros(0)
    x, at = np.maximum.accumulate(sign * theta_b[b]), sign * theta_a[a]
    inside = (at > x[0]) & (at < x[-1]) & beside_a_row(at, x)
    if inside.sum() <= OVERLAP:
        return np.zeros(0)
    return np.asarray(e_a[a][inside] - np.interp(at[inside], x, e_b[b]))


def beside_a_row(at: Array, x: Array) -> npt.NDArray[np.bool_]:
    """Which of the angles `at` (n,) lie between two rows of `x` (m,), rising, that follow each other, not in a hole."""
    hole = HOLE * float(x[-1] - x[0]) / max(x.size - 1, 1)  # the mean: a motor that sticks has a median of nothing
    above = np.clip(np.searchsorted(x, at), 1, x.size - 1)
    return np.asarray(x[above] - x[above - 1] <= max(hole, 1e-12))


def scatter(eq: Equations, e: Mapping[Key, Array], pair: tuple[int, int], channel: str) -> Scatter | None:
    """One pair in one channel; None when the runs share too little."""
    a, b = (pair[0], channel), (pair[1], channel)
    if a not in e or b not in e:
        return None
    theta_a, theta_b = eq.rows[a].theta_m, eq.rows[b].theta_m
    d = compare(theta_a, e[a], theta_b + output_turns(theta_a, theta_b, eq.runs[pair[0]].ratio), e[b])
    if channel == "M" and d.size < FLOOR_LEAST:  # of what is on the motor's side the output's angle is no part
        d = compare(theta_a, e[a], theta_b + motor_turns(theta_a, theta_b), e[b])
    if d.size < FLOOR_LEAST or not np.any(d):  # a copy of a run is no repeat
        return None
    offset = float(d.mean())
    d = d - offset
    return Scatter(pair, float(np.sqrt(np.mean(d**2))), d.size, offset, autocorrelation(d), freedom(d))


def output_turns(theta_a: Array, theta_b: Array, ratio: float) -> float:
    """Whole turns of the output that bring b next to a, as motor angle [rad]; 0 where their number is no whole one.

    The motor is where the last run left it: repeats at constant torque begin anywhere. After a turn of the output both
    angles are what they were; after one of the motor alone the output is not.
    """
    if abs(ratio - round(ratio)) > WHOLE:
        return 0.0
    return _turns(theta_a, theta_b, 2 * np.pi * round(ratio))


def motor_turns(theta_a: Array, theta_b: Array) -> float:
    """Whole turns of the motor that bring b next to a, rad: where both runs began anywhere."""
    return _turns(theta_a, theta_b, 2 * np.pi)


def _turns(theta_a: Array, theta_b: Array, turn: float) -> float:
    middle = 0.5 * (theta_a.min() + theta_a.max() - theta_b.min() - theta_b.max())
    return float(turn * np.round(middle / turn))


def autocorrelation(d: Array) -> Array:
    """Of lag 0 to 60 rows (half a second), shape (61,)."""
    m = 2 ** int(np.ceil(np.log2(2 * d.size)))
    spectrum = np.abs(np.fft.rfft(d, m)) ** 2
    return np.asarray(np.fft.irfft(spectrum)[:61] / max(spectrum.sum() / m * 2, 1e-300))


def freedom(d: Array) -> float:
    """Degrees of freedom of the mean square of `d` (n,), from its spectrum: (ΣP)²/ΣP²      [bartlett1950]"""
    power = np.abs(np.fft.rfft(d)) ** 2
    return float(max(1.0, power.sum() ** 2 / max(float(power @ power), 1e-300)))


def effective(rho: Array) -> float:
    """Rows per independent row: 1 + 2·Σρ up to where it vanishes."""
    rho = rho / max(float(rho[0]), 1e-300)
    gone = np.flatnonzero(rho < UNCORRELATED)
    return float(max(1.0, 1 + 2 * rho[1 : int(gone[0]) if gone.size else rho.size].sum()))
