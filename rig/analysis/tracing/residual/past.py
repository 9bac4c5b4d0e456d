"""What a torque or a speed has been, as a coordinate of the present: how far a play, a slow spring or a sum of it is
behind, in the unit of what is given.

A rest with memory follows none of the things that are measured at the same moment. Three kinds of memory, each of a few
sizes, cover what gears and sensors do: they keep a part of the last excursion (play), forget with time (leak) or keep
everything (sum).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from rig.model.effect import Array
from rig.model.memory import follower, play

WIDTHS: Final = (0.03, 0.1, 0.3)  # of the largest torque: half widths of a play
LEAKS: Final = (1.5, 8.0, 40.0)  # s: between a turn of the motor and a run
STOOD: Final = 0.5  # s without a row that turns: no reversal takes so long
LARGEST: Final = 0.99  # quantile of |torque| that counts as the largest


def behind(torque: Array, run: Array, width: float) -> Array:
    """How far a play of `width` times the largest torque is behind, run by run; N·m, (n,), NaN where there is none."""
    good = np.isfinite(torque)
    if not good.any():
        return torque
    half = width * float(np.quantile(np.abs(torque[good]), LARGEST))
    return _by_run(torque, run, lambda x: x - play(x, half))


def relaxing(torque: Array, run: Array, dt: float, leak: float) -> Array:
    """How far a first-order follower of time constant `leak` s is behind, at rest when the run begins; N·m, (n,)."""
    keep = float(np.exp(-dt / leak))
    return _by_run(torque, run, lambda x: x - x[0] - follower(x - x[0], 1 - keep, 0.0, keep, 0.0))


def summed(torque: Array, run: Array, dt: float) -> Array:
    """Torque times time since the run began, about its mean: each run has a zero of its own; N·m·s, (n,)."""

    def about_mean(x: Array) -> Array:
        total = np.cumsum(x) * dt
        return total - float(np.mean(total))

    return _by_run(torque, run, about_mean)


def since_turned(angle: Array, way: Array, run: Array) -> Array:
    """How far the motor has gone since it last turned back or stood, rad, (n,): what wears off or builds up on the
    way."""
    out = np.zeros(angle.size)
    for one in np.unique(run):
        mine = np.flatnonzero(run == one)
        changed = np.flatnonzero(np.diff(way[mine], prepend=way[mine][:1]) != 0)
        start = np.zeros(mine.size, dtype=int)
        start[changed] = changed
        since = np.maximum.accumulate(start)
        out[mine] = np.abs(angle[mine] - angle[mine][since])
    return out


def slid(angle: Array, time: Array, run: Array) -> Array:
    """How far the motor has gone, forth and back, since it last rested for STOOD s or the run began, rad, (n,)."""
    out = np.zeros(angle.size)
    for one in np.unique(run):
        mine = np.flatnonzero(run == one)
        gone = np.cumsum(np.abs(np.diff(angle[mine], prepend=angle[mine][:1])))
        start = np.where(np.diff(time[mine], prepend=-np.inf) > STOOD, gone, 0.0)
        out[mine] = gone - np.maximum.accumulate(start)
    return out


def _by_run(torque: Array, run: Array, memory: Callable[[Array], Array]) -> Array:
    out = np.full(torque.size, np.nan)
    for one in np.unique(run):
        mine = (run == one) & np.isfinite(torque)
        if mine.any():
            out[mine] = memory(np.ascontiguousarray(torque[mine]))
    return out
