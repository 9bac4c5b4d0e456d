"""The floor: what differs between two runs of the same condition at the same motor angle."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.common_orders import without_common_orders
from rig.analysis.tracing.runs.recording import Recording, mean_way
from rig.analysis.tracing.thresholds import FLOOR_LEAST, UNCORRELATED
from rig.model.effect import Array

CLOSE = 0.05  # relative: travel and speed of repeats agree so well
SLIPS = 0.2  # the same of the speed of a locked run: a motor that sticks and slips goes back and forth now and then
READINGS = 100  # of the angle of a locked run: a few for every stroke
SAME_LOAD = 1.0  # N·m, how far the means of repeats lie apart: zeros of a sensor, friction that scatters
ONE_WAY = 0.9  # of the rows, less those the other way
WHOLE = 1e-9  # of a ratio: the teeth of a strain-wave gear make it a whole number, or far from one
HOLE = 10.0  # usual distances between rows: further apart, there is nothing between them
SOON = 3.0  # times the usual gap between repeats: later ones may have drifted


@dataclass(frozen=True)
class Scatter:
    """Differences of one pair in one channel, as RMS of a single run, and the autocorrelation of its rows."""

    pair: tuple[int, int]
    rms: float
    rows: int
    offset: float  # difference of the two means over sqrt 2
    rho: Array
    freedom: float  # independent parts the RMS is made of: a gain that is never twice the same is one


def repeats(runs: Sequence[Recording], among: Sequence[int]) -> list[tuple[int, int]]:
    """Pairs of runs of the same condition, each run once, nearest in time first."""
    pairs = sorted(
        (abs(runs[j].start - runs[i].start), i, j) for i in among for j in among if i < j and alike(runs[i], runs[j])
    )
    used: set[int] = set()
    out: list[tuple[float, int, int]] = []
    for gap, i, j in pairs:
        if i not in used and j not in used:
            used |= {i, j}
            out.append((gap, i, j))
    usual = float(np.median([gap for gap, _, _ in out])) if out else 0.0
    return [(i, j) for gap, i, j in out if gap <= SOON * usual]


def alike(a: Recording, b: Recording) -> bool:
    """Same words, and the same motion, the same way round and under the same torque: words may leave both out."""
    if "tau_l" in a.has & b.has and not np.isclose(a.mean_torque, b.mean_torque, rtol=CLOSE, atol=SAME_LOAD):
        return False
    return moved_alike(a, b)


def moved_alike(a: Recording, b: Recording) -> bool:
    """The same, whatever the torque reads."""
    if a.said != b.said or a.has != b.has or a.locked != b.locked or _heading(a) * _heading(b) < 0:
        return False
    close = (CLOSE, SLIPS) if a.locked else (CLOSE, CLOSE)
    ways = zip(travel(a), travel(b), close, strict=True)
    return all(abs(u - v) <= least * max(abs(u), abs(v), 1e-9) for u, v, least in ways)


def travel(run: Recording) -> tuple[float, float]:
    """Range of the motor angle over the time it took, and mean |speed|; rad/s. Length of a run does not matter. Of a
    locked run the range, and the mean speed read now and then: what the motor trembles on its counts is no way gone."""
    low, high = min(float(p.theta_m.min()) for p in run.pieces), max(float(p.theta_m.max()) for p in run.pieces)
    if run.locked:
        return high - low, sum(_gone(p.theta_m) for p in run.pieces) / sum(p.t.size * p.dt for p in run.pieces)
    speed = float(np.mean([np.mean(np.abs(p.omega_m)) for p in run.pieces]))
    turning = abs(float(np.mean([np.mean(p.omega_m) for p in run.pieces]))) > 0.5 * speed
    return speed, speed if turning else high - low


def _heading(run: Recording) -> int:
    """1 or −1 of a run that turns one way, else 0: conditions may give a speed without its sign."""
    if run.locked:
        return 0
    way = mean_way(run)
    return 0 if abs(way) < ONE_WAY else int(np.sign(way))


def _gone(theta: Array) -> float:
    """Way of an angle (n,) between READINGS of it, rad."""
    return float(np.abs(np.diff(theta[:: max(1, theta.size // READINGS)])).sum())


def strokes(theta: Array) -> list[slice]:
    """Rows lo..hi between reversals of the motor angle; parts too short to compare are left out."""
    if theta.size < 3:
        return []
    wide = max(3, theta.size // 400)
    slow = np.convolve(theta, np.ones(wide) / wide, mode="valid")
    step = np.sign(np.diff(slow))
    step[step == 0] = 1
    cuts = [0, *(int(c) + 1 + wide // 2 for c in np.flatnonzero(np.diff(step))), theta.size]
    return [slice(lo, hi) for lo, hi in itertools.pairwise(cuts) if hi - lo > 25]


def compare(theta_a: Array, e_a: Array, theta_b: Array, e_b: Array) -> Array:
    """Differences of two residuals at equal motor angle, stroke by stroke, as if of one run; (n,)."""
    both = without_common_orders(np.concatenate([theta_a, theta_b]), np.concatenate([e_a, e_b]))
    e_a, e_b = both[: e_a.size], both[e_a.size :]
    parts = []
    for a, b in zip(strokes(theta_a), strokes(theta_b), strict=False):
        sign = np.sign(theta_b[b][-1] - theta_b[b][0])
        if sign != np.sign(theta_a[a][-1] - theta_a[a][0]):
            continue
        x, at = np.maximum.accumulate(sign * theta_b[b]), sign * theta_a[a]
        inside = (at > x[0]) & (at < x[-1]) & beside_a_row(at, x)
        if inside.sum() > 25:
            parts.append(e_a[a][inside] - np.interp(at[inside], x, e_b[b]))
    if not parts:
        return np.zeros(0)
    d = np.concatenate(parts)
    rho = float(np.clip(d[1:] @ d[:-1] / max(d @ d, 1e-300), 0.0, 1.0))
    # interpolation between two rows of correlation rho leaves 2/3 + rho/3 of their variance
    return np.asarray(d / np.sqrt(1 + 2 / 3 + rho / 3))


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
    turn = 2 * np.pi * round(ratio)
    if abs(ratio - round(ratio)) > WHOLE:
        return 0.0
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
