"""The run cut at the turning points of the wind-up: ramps with their direction and rate, and the holds between them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.strokes import turning_points

TURNED = 0.1  # of the whole wind-up: going back by less is stick-slip or noise, not a turn
ENDS = 0.01  # of the whole wind-up: within it of a turn, the rows belong to the turn
SHORT = 0.4  # of the whole torque range: a shorter ramp is not used
WHOLE = 0.8  # of it: from one end to the other
ON_LOOP = 0.5  # of the largest torque: a ramp that starts below it began inside the loop, not on it
LEAST = 16  # rows a ramp needs


@dataclass(frozen=True)
class Ramp:
    """One way up or down: the rows `lo` ≤ i < `hi` between its turns."""

    lo: int
    hi: int
    direction: int  # of the wind-up
    begin: float  # rad, wind-up at the turn it started from
    rate: float  # rad/s of wind-up in the mean, positive; NaN without time
    whole: bool  # from one end of the torque to the other
    on_loop: bool  # it started from a turn under load, so its place on the hysteresis loop is known


@dataclass(frozen=True)
class Hold:
    """The rows `lo` ≤ i < `hi` between two ramps, or after the last: the wind-up stands still, at a turn."""

    lo: int
    hi: int
    direction: int  # of the ramp before
    loading: int  # row at which that ramp began


def cut(windup: Array, tau: Array, t: Array | None) -> tuple[list[Ramp], list[Hold]]:
    """Ramps and what lies between them, in time order. `windup` rad, `tau` N·m, `t` s, all (n,)."""
    whole, span = float(np.ptp(windup)), float(np.ptp(tau))
    if not (whole > 0 and span > 0):
        return [], []
    pivots = turning_points(windup, TURNED * whole)
    ramps: list[Ramp] = []
    edges: list[tuple[int, int, int]] = []  # first row of a ramp, one past its last, direction
    for lo, hi in pairwise(pivots):
        first, last = _moving(windup, lo, hi, ENDS * whole)
        edges.append((first, last, 1 if windup[hi] > windup[lo] else -1))
        if last - first >= LEAST and np.ptp(tau[first:last]) >= SHORT * span:
            ramps.append(_ramp(windup, tau, t, lo, first, last, span))
    ends = [*(first for first, *_ in edges[1:]), windup.size]
    holds = [Hold(last, end, way, first) for (first, last, way), end in zip(edges, ends, strict=True)]
    return ramps, holds


def _moving(windup: Array, lo: int, hi: int, near: float) -> tuple[int, int]:
    """First row that has left the turn at `lo`, and the row before which it had not yet arrived at the one at `hi`."""
    piece = windup[lo : hi + 1]
    left = np.flatnonzero(np.abs(piece - piece[0]) <= near)[-1] + 1
    arrived = np.flatnonzero(np.abs(piece - piece[-1]) <= near)[0]
    return lo + int(left), lo + max(int(arrived), int(left))


def _ramp(windup: Array, tau: Array, t: Array | None, turn: int, lo: int, hi: int, span: float) -> Ramp:
    direction = 1 if windup[hi - 1] > windup[lo] else -1
    rate = float("nan")
    if t is not None:
        rate = abs(float(windup[hi - 1] - windup[lo])) / max(float(t[hi - 1] - t[lo]), 1e-9)
    most = float(np.max(np.abs(tau)))
    return Ramp(
        lo,
        hi,
        direction,
        float(windup[turn]),
        rate,
        whole=bool(np.ptp(tau[lo:hi]) >= WHOLE * span),
        on_loop=bool(direction * tau[turn] < -ON_LOOP * most),
    )
