"""Creep at the holds: how the wind-up that the spring does not explain grows with the logarithm of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.stiffness.branches import Hold
from rig.analysis.stiffness.curve import Curve
from rig.analysis.stiffness.loop import Value

FIRST = 0.1  # s after arrival: before, the motor still comes to rest
DECADES = 0.8  # of time a hold has to span
ARRIVED = 5e-4  # of the reach: nearer than this to where it is held, the ramp is over
LOADED = 0.5  # of the largest torque: less is no hold under load
STEPS = 24  # means in equal steps of log t, so that late rows do not outweigh early ones


@dataclass(frozen=True)
class Creep:
    """Of all holds together."""

    per_decade: Value  # share of the wind-up per decade of time after a sudden load
    holds: int
    longest: float  # s
    time: Array  # s since arrival, (s,), mean of the holds
    windup: Array  # rad, (s,), from the first step


@dataclass(frozen=True)
class Series:
    """One hold."""

    time: Array  # s since arrival, (s,)
    moved: Array  # rad, (s,)
    size: float  # rad, of the ramp before
    loading: float  # s, it took


def creep(holds: list[Hold], curve: Curve, windup: Array, tau: Array, t: Array | None) -> Creep | None:
    """w − τ/K in the direction of the load, K the local slope: creep at constant torque and relaxation at constant
    wind-up come out alike. None without time, or without a hold that is long, still and loaded enough.

    The ramp before took time, during which its first part crept already: what is left of log-time creep after a ramp of
    t_r is c·[(t + t_r)·log(t + t_r) − t·log t]/t_r per unit of load (superposition), and c is what is given.
    """
    if t is None:
        return None
    series = [s for hold in holds if (s := _series(hold, curve, windup, tau, t)) is not None]
    if not series:
        return None
    shares = np.array([_slope(_after_ramp(s.time, s.loading), s.moved) / s.size for s in series])
    n = shares.size
    half = t95(n - 1) * float(shares.std(ddof=1)) / np.sqrt(n) if n > 1 else float("nan")
    time = min((s.time for s in series), key=lambda x: float(x[-1]))
    mean = np.mean([np.interp(np.log(time), np.log(s.time), s.moved) for s in series], axis=0)
    longest = max(float(s.time[-1]) for s in series)
    return Creep(Value(float(shares.mean()), half), n, longest, time, mean - mean[0])


def _after_ramp(time: Array, loading: float) -> Array:
    """Creep of one decade's worth per unit of load, `time` s after the end of a ramp that took `loading` s."""
    total = time + loading
    return np.asarray((total * np.log10(total) - time * np.log10(time)) / loading)


def _slope(x: Array, y: Array) -> float:
    x = x - x.mean()
    return float(x @ y) / float(x @ x)


def _series(hold: Hold, curve: Curve, windup: Array, tau: Array, t: Array) -> Series | None:
    """None when it is no hold under load, or too little of it is sure to be a hold: for as long
    as a ramp takes for one count, it may not have ended, or the next have begun.
    """
    w, y = windup[hold.lo : hold.hi], tau[hold.lo : hold.hi]
    if w.size < 2 * STEPS:
        return None
    rest, half = float(np.median(w)), w.size // 2
    # the hold is where the wind-up is no farther off than in its middle: before it arrives, after it leaves
    near = max(4.0 * float(np.std(w[half // 2 : -half // 2])), ARRIVED * curve.scale.reach)
    moving = np.abs(w - rest) > near
    begin = int(np.max(np.flatnonzero(moving[:half]), initial=-1)) + 1
    end = half + int(np.min(np.flatnonzero(moving[half:]), initial=w.size - half))
    if end - begin < 2 * STEPS:
        return None
    arrival = hold.lo + begin
    size, loading = abs(rest - float(windup[hold.loading])), float(t[arrival] - t[hold.loading])
    unsure = _step(windup[hold.loading : hold.lo]) * loading / max(size, 1e-300)
    since, w, y = t[arrival : hold.lo + end] - t[arrival], w[begin:end], y[begin:end]
    first, last = max(FIRST, unsure), float(since[-1]) - unsure
    use = (since >= first) & (since <= last)
    loaded = abs(float(np.median(y))) > LOADED * curve.scale.torque
    if not loaded or use.sum() < 2 * STEPS or last < first * 10**DECADES:
        return None
    u = rest - curve.middle
    K = float(curve.tangent(np.array([rest]))[0])
    moved = np.sign(u) * (w[use] - y[use] / K)
    cell = np.searchsorted(np.geomspace(first, last, STEPS + 1)[1:-1], since[use])
    rows = np.bincount(cell, minlength=STEPS)
    here = rows > 0
    time = np.exp(np.bincount(cell, np.log(since[use]), STEPS)[here] / rows[here])
    return Series(time, np.bincount(cell, moved, STEPS)[here] / rows[here], size, loading)


def _step(windup: Array) -> float:
    """How far the wind-up usually moves when it moves [rad]: a count, or what the ramp makes of a row."""
    steps = np.abs(np.diff(windup))
    return float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0
