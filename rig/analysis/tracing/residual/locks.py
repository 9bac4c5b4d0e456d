"""A spring that is not the same twice: lock tests that differ from each other far more than runs that turn freely do.

Repeats of a lock test tell its floor, so what makes them differ is in it and never above it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.noise import Measured
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Rest, rest
from rig.analysis.tracing.residual.readings import waves
from rig.analysis.tracing.thresholds import LOCKS_DIFFER, PLAIN_ENOUGH
from rig.core.units import TURN
from rig.model.effect import Array

SLOWEST: Final = 3.0  # periods in a lock test at least: less is a drift
FASTEST: Final = 0.8  # Hz
FINE: Final = 4  # frequencies tried for every whole wave more in all lock tests together
FEWEST: Final = 2  # lock tests


def lock_tests_differ(eq: Equations, measured: Measured, e: Mapping[Key, Array]) -> tuple[Home, float] | None:
    """What the stiffness of the lock tests follows, and how many times as much they differ by as free runs do; None
    where they do not. `e`: residuals (n,) by block, of fitted and held-out runs."""
    known = {i: rms for (i, c), rms in measured.by_run.items() if c == "A"}
    locked = [rms for i, rms in known.items() if eq.runs[i].locked]
    free = [rms for i, rms in known.items() if not eq.runs[i].locked]
    if len(locked) < FEWEST or not free:
        return None
    usual = float(np.median(free))
    times = float(np.sqrt(np.mean(np.square(locked)))) / usual
    mine = {key: x for key, x in e.items() if key[1] == "A" and eq.runs[key[0]].locked}
    r = rest(eq, mine, dict.fromkeys(mine, usual), "A", beside=False) if times > LOCKS_DIFFER else None
    return None if r is None else (_followed(r), times)


def _followed(r: Rest) -> Home:
    """The temperature where it does nearly as well as a stiffness of each run's own; a wave of the clock where that
    does better; else the time."""
    y, torque = _still(r.e, r.run), np.nan_to_num(r.at["load"])
    excess = max(float(y @ y) - y.size, 1e-9)

    def share(columns: Array) -> float:
        z = np.stack([_still(c, r.run) for c in columns.T], 1)
        return float(y @ (z @ np.linalg.lstsq(z, y, rcond=None)[0])) / excess

    own = share(torque[:, None] * (r.run[:, None] == np.unique(r.run)))
    heights = {float(f): share(torque[:, None] * waves(TURN * r.at["time"], f)) for f in _tried(r)}
    frequency = max(heights, key=lambda f: heights[f], default=None)
    height = 0.0 if frequency is None else heights[frequency]
    warm = r.at["temperature"]
    if np.isfinite(warm).all() and np.ptp(warm) > 0:
        by_warmth = share(np.stack([torque, torque * (warm - warm.mean())], 1))
        if by_warmth > PLAIN_ENOUGH * max(own, height):
            return Home("temperature", "A", by_warmth)
    if frequency is not None and PLAIN_ENOUGH * height > own:
        return Home("time_periodic", "A", height, frequency_hz=frequency)
    return Home("time", "A", own)


def _tried(r: Rest) -> Array:
    """Frequencies, Hz; none where there is no time."""
    if not r.timed:
        return np.zeros(0)
    shortest = min(float(np.ptp(r.at["time"][r.run == run])) for run in np.unique(r.run))
    return np.arange(SLOWEST / shortest, FASTEST, 1 / FINE / float(np.ptp(r.at["time"])))


def _still(x: Array, run: Array) -> Array:
    """Without its mean in every run, (n,)."""
    _, at = np.unique(run, return_inverse=True)
    return np.asarray(x - (np.bincount(at, x) / np.bincount(at))[at])
