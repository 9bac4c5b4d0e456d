"""Seconds of a run that stand out against the rest of the same run: something that grabs, a dent that is passed.

It raises what repeats, or neighbouring turns, differ by, and with them the floor it is held against; the usual half
second of a run does not know of it. On campaigns that lack nothing no half second has more than 2.5 times the usual
one, and no run more than 1.23 times. Usual is what half seconds of a like speed have: a log of jogs is louder
where it is fast. And friction that wanders from second to second has half seconds of all kinds: what stands out is
loud beside other runs too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.local import at_rows, clock
from rig.analysis.tracing.thresholds import BURST, BURST_RUN
from rig.model.effect import Array

LENGTH: Final = 0.5  # s
FEWEST: Final = 12  # half seconds in a run: of fewer the usual one is not known
LIKE: Final = 1.5  # times another speed: what either leaves is about the same
LOUDER: Final = 4.0  # times the RMS of other runs: of noise as slow as half a second one in 16 000 is
BURSTS: Final = 2.0  # times its usual half second: runs of clean campaigns have 1.1, of exam 98, case 04, 2.6 to 3.6
OTHERS: Final = 3  # runs of which the middle one's RMS is known
SLOW: Final = 0.5  # rad/s of the motor: below that speeds are all alike


@dataclass(frozen=True)
class Burst:
    """The loudest of a run and channel: between which times [s], RMS of the run over the usual half second's."""

    key: Key
    since: float
    until: float
    over: float


def loudest_burst(eq: Equations, e: Mapping[Key, Array]) -> Burst | None:
    """Of all residuals (n,) by run and channel, reversals left out; None where nothing stands out."""
    levels = {key: _level(eq, key, x) for key, x in e.items()}
    found = (burst(eq, key, e[key], _of_others(key, levels)) for key in e if key[1] != "R")
    return max((b for b in found if b is not None), key=lambda b: b.over, default=None)


def _level(eq: Equations, key: Key, e: Array) -> float:
    """RMS of a run; of one that is bursts mostly, that of its usual half seconds: what every run has would stand out in
    none."""
    _, levels, speeds = half_seconds(eq, key, e)
    whole = float(np.sqrt(np.mean(e**2)))
    if levels.size < FEWEST:
        return whole
    usual = float(np.sqrt(np.mean(_usual(levels, speeds) ** 2)))
    return usual if whole > BURSTS * usual else whole


def _of_others(key: Key, levels: Mapping[Key, float]) -> float:
    """That of the middle one of the other runs of a channel; 0 where there are too few."""
    others = [level for other, level in levels.items() if other != key and other[1] == key[1]]
    return float(np.median(others)) if len(others) >= OTHERS else 0.0


def burst(eq: Equations, key: Key, e: Array, of_others: float = 0.0) -> Burst | None:
    """From the first to the last half second that stands out, beside the usual RMS `of_others` too; None where none
    does, or the run is too short."""
    t, levels, speeds = half_seconds(eq, key, e)
    if levels.size < FEWEST:
        return None
    usual = _usual(levels, speeds)
    over = float(np.sqrt(np.mean(e**2) / max(float(np.mean(usual**2)), 1e-300)))
    least = max(_rounded(eq, key), LOUDER * of_others)
    loud = np.flatnonzero(levels > np.maximum(BURST * usual, least))
    if over < BURST_RUN or not loud.size:
        return None
    return Burst(key, float(t[loud[0]]), float(t[loud[-1]]) + LENGTH, over)


def loud_half_seconds(eq: Equations, key: Key, e: Array) -> Array:
    """When those begin that stand out against the rest of their run, since that did [s]."""
    t, levels, speeds = half_seconds(eq, key, e)
    return t if levels.size < FEWEST else np.asarray(t[levels > BURST * _usual(levels, speeds)])


def _usual(levels: Array, speeds: Array) -> Array:
    """Of each half second the usual level (k,) of those at like speeds [rad/s], or of the nearest few: what grabs slows
    a motor down too."""
    scale = np.log(np.maximum(speeds, SLOW)) / np.log(LIKE)
    near = np.round(scale)
    out = np.empty(levels.size)
    for step in np.unique(near):
        mine = near == step
        if np.count_nonzero(mine) >= FEWEST:
            out[mine] = np.median(levels[mine])
        for i in np.flatnonzero(mine) if np.count_nonzero(mine) < FEWEST else ():
            out[i] = np.median(levels[np.argsort(np.abs(scale - scale[i]))[:FEWEST]])
    return out


def _rounded(eq: Equations, key: Key) -> float:
    """What a reading at rest may be off by, rad: half a count of both encoders stays as long as nothing turns."""
    run, channel = eq.runs[key[0]], key[1]
    return 0.5 * (run.step_m / run.ratio + run.step_l) if channel == "A" else 0.0


def half_seconds(eq: Equations, key: Key, e: Array) -> tuple[Array, Array, Array]:
    """When each begins, since the run did [s], RMS of `e` (n,) in it, and how fast the motor turns [rad/s]."""
    t = clock(eq, key)
    if t.size == 0:
        return t, t, t
    place = np.floor((t - t[0]) / LENGTH).astype(int)
    count = np.bincount(place)
    full = count > 0.5 * np.median(count[count > 0])
    levels: Array = np.sqrt(np.bincount(place, e**2)[full] / count[full])
    speeds: Array = np.bincount(place, np.abs(at_rows(eq, key, "omega_m")))[full] / count[full]
    return np.asarray(LENGTH * np.flatnonzero(full)), levels, speeds


def usual_levels(eq: Equations, e: Mapping[Key, Array]) -> dict[Key, float]:
    """RMS of the usual half second of every run and channel."""
    return {key: max(float(np.median(half_seconds(eq, key, x)[1])), 1e-300) for key, x in e.items() if x.size}
