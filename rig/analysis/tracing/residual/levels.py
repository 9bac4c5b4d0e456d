"""Friction that is another one at one speed, told by what runs have in common and not by the floor of a single run.

A hump of friction at one speed makes all of a run at that speed stand off, and of what stands off a run keeps a part
only, for friction scatters from run to run. Under the floor of one run it is plain to see in several: forth and back,
in repeats and long after. A one-way analysis of variance, whose groups are the speeds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import fdtrc

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.residual.coordinates import both
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Index, Rest, rest
from rig.analysis.tracing.residual.readings import in_bins
from rig.model.effect import Array

APART: Final = 1.1  # of two speeds: runs at one speed differ by less
OWN: Final = 0.9  # of a run's mean: where more is the run's own, nothing is known of it
TURNING: Final = 0.1  # of the rows, less those the other way: a run that goes as far forth as back
LEVELS: Final = 3  # speeds: a constant and a slope of the baseline go through two
FREE: Final = 8  # degrees of freedom within them, from which a variance is known
BY_CHANCE: Final = 1e-4  # clean campaigns come to this once in ten thousand, two channels each
LARGE: Final = 0.5  # of the floor, RMS of the largest level: less moves no error by an eighth
FRICTION: Final = ("M", "L")  # channels in which friction stands


@dataclass(frozen=True)
class Runs:
    """What each of k runs has left that turns with its way, over the floor (k,), its speed [rad/s], its mean way from
    −1 to 1, when it was taken [s of the campaign], and which it is, all (k,)."""

    left: Array
    speed: Array
    way: Array
    since: Array
    number: Index


def of_turning(eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float]) -> dict[str, Rest]:
    """What residuals `e` of runs that turn leave in the channels in which friction stands, runs joined; without those
    that were not measured."""
    turning = {key: x for key, x in e.items() if not eq.runs[key[0]].locked}
    joined = {channel: rest(eq, turning, floors, channel, beside=False) for channel in FRICTION}
    return {channel: r for channel, r in joined.items() if r is not None}


def friction_by_speed(rests: Mapping[str, Rest]) -> Home | None:
    """Where the rests of runs that turn, fitted or not, by channel, have the same left at one speed beyond what runs at
    that speed differ by; None where they have not."""
    found = [_in_channel(channel, r) for channel, r in rests.items()]
    return max((home for home in found if home is not None), key=lambda home: home.share, default=None)


def _in_channel(channel: str, r: Rest) -> Home | None:
    runs = left_by_runs(r)
    level = levels(runs.speed)
    share = between(runs.left, level)
    if share is None:
        return None
    edges = _edges(runs.speed, level)

    def index(r: Rest) -> Index:
        """The speed's level, forth and back apart."""
        return both(np.digitize(np.abs(r.at["speed"]), edges), (r.at["direction"] + 1).astype(int))

    return Home("speed", channel, share, read=in_bins(index))


def left_by_runs(r: Rest, uneven: float = TURNING) -> Runs:
    """Of runs that turn one way, or as far forth as back but for a share of `uneven`. What was taken off a mean as the
    run's own is put back."""
    left, speed, ways, since, number = [], [], [], [], []
    for run in np.unique(r.run):
        mine = r.run == run
        way, own = np.sign(r.at["direction"][mine]), float(np.mean(r.offset[mine]))
        one_way = float(np.mean(way))
        kept = 1.0 - own * one_way**2
        if uneven < abs(one_way) < 1.0 - TURNING or kept < 1.0 - OWN:
            continue
        left.append(float(np.mean(r.e[mine] * way)) / kept)
        speed.append(float(np.mean(np.abs(r.at["speed"][mine]))))
        ways.append(one_way)
        since.append(float(np.mean(r.at["time"][mine])))
        number.append(run)
    return Runs(np.array(left), np.array(speed), np.array(ways), np.array(since), np.array(number, np.int64))


def levels(speed: Array) -> Index:
    """The level of each of `speed` (k,): neighbours less than APART times each other share one."""
    order = np.argsort(speed)
    ratio = speed[order][1:] / np.maximum(speed[order][:-1], 1e-9)
    out = np.zeros(speed.size, np.int64)
    out[order[1:]] = np.cumsum(ratio > APART)
    return out


def _edges(speed: Array, level: Index) -> Array:
    """Between the levels."""
    means = np.array([speed[level == n].mean() for n in range(int(level.max()) + 1)])
    return np.asarray(np.sqrt(means[1:] * means[:-1]))


def between(left: Array, level: Index) -> float | None:
    """The share of `left` (k,) that lies between levels; None where there are too few runs to tell, or chance does as
    much, or it is small beside the floor."""
    groups = [left[level == n] for n in np.unique(level)]
    several = [group for group in groups if group.size > 1]
    free = sum(group.size - 1 for group in several)
    if len(several) < LEVELS or free < FREE:
        return None
    values = np.concatenate(several)
    within = sum(float(np.var(group)) * group.size for group in several)
    total = float(np.var(values)) * values.size
    variance = max(within / free, 1e-300)
    ratio = (total - within) / (len(several) - 1) / variance
    largest = max(abs(float(group.mean() - values.mean())) for group in several)
    if fdtrc(len(several) - 1, free, ratio) > BY_CHANCE or largest < LARGE:
        return None
    return float(1.0 - within / total)
