"""Angles as counters give them: their wrap undone, and the ratio two of them show."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.core.rows import room, stretches
from rig.core.units import TURN

ALONG = 0.05  # how far θ_l may be from θ_m/N over any run: kinematic error and wind-up take a hundredth of it
RATIO = 0.01  # the same where θ_l misses by more than wind-up can
WIND_UP = 0.03  # rad at the output: 200 N·m on the softest of the paper's kind of gear
FARTHEST = 2 * TURN  # rad from end to end: a wrapped angle has one turn, and a reading that fell out perhaps more

Index = npt.NDArray[np.int64]
NONE: Index = np.empty(0, np.int64)


def unwrap(values: Array, period: float) -> Array:
    """Undo the wrap of a counter or an angle of `period` (unit of `values`), shape (n,).

    A step of more than half a period between neighbours is taken for a wrap, so the true step must stay below that.
    """
    out, turns = room(values.size), 0.0
    for some in stretches(values.size):
        step = np.diff(values[some], prepend=values[max(some.start - 1, 0)])
        whole = turns + np.cumsum(np.round(step / period))
        out[some] = values[some] - whole * period
        turns = float(whole[-1])
    return out


def is_wrapped(theta: Array, gaps: Index = NONE) -> bool:
    """Whether `theta` [rad] jumps by whole turns now and then, as an angle that nobody unwrapped does.

    A step before one of the rows `gaps` is motion that was not recorded, and an angle that goes far beyond a turn was
    never wrapped.
    """
    jumps, count = _jumps(theta, gaps), theta.size - 1
    if jumps.size == 0 or jumps.size > 0.05 * count:  # a motor that really does half a turn per row does so often
        return False
    if float(theta.max() - theta.min()) > FARTHEST:
        return False
    usual = float(np.median(np.diff(theta)))
    turns = (jumps - usual) / TURN
    return bool(np.all(np.abs(turns - np.round(turns)) < 0.1))


def _jumps(theta: Array, gaps: Index) -> Array:
    """The steps of more than half a turn, but for those before the rows `gaps`."""
    rows = [
        start + 1 + np.flatnonzero(np.abs(np.diff(theta[start : some.stop])) > TURN / 2)
        for some in stretches(theta.size)
        for start in [max(some.start - 1, 0)]
    ]
    after = np.setdiff1d(np.concatenate(rows), gaps)
    return np.asarray(theta[after] - theta[after - 1])


def joined(theta_m: Array, theta_l: Array, ratio: float, gaps: Index) -> Array:
    """`theta_m` [rad] with as many whole turns added after each of the rows `gaps` as the load angle says.

    How often a wrapped angle went round while no row was recorded it does not say itself. The load goes N times slower
    and θ̃ is a hundredth of a motor turn at most: N·Δθ_l tells the turns.
    """
    missed = ratio * (theta_l[gaps] - theta_l[gaps - 1]) - (theta_m[gaps] - theta_m[gaps - 1])
    out = theta_m
    for row, turns in zip(gaps, np.round(missed / TURN), strict=True):
        if turns:
            out = out.copy() if out is theta_m else out
            out[row:] += turns * TURN
    return out


def measured_ratio(theta_m: Array, theta_l: Array) -> float:
    """Motor turns per load turn as the two encoders say it, by least squares; inf when the load did not move."""
    x = theta_l - theta_l.mean()
    y = theta_m - theta_m.mean()
    cross = float(x @ y)
    return float(y @ y) / cross if cross else float("inf")


def is_another_ratio(slope: float, travel: float) -> bool:
    """Is Δθ_l/(Δθ_m/N) = `slope` more than kinematic error and wind-up make over `travel` [rad] of the load?"""
    off = abs(slope - 1)
    return off >= RATIO and (off >= ALONG or off * travel >= WIND_UP)
