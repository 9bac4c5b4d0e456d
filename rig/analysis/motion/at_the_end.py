"""A sensor at the end of its range: it says its largest reading again and again, while the shaft goes on.

A torque that is cut off so has the course of no torque: what is missing of it would be looked for in the gear.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.core.rows import stretches

FEWEST: Final = 20  # readings of the one value: the top of a wave is reached now and then
SHARE: Final = 1e-3  # of the rows, at least
LEVELS: Final = 10  # the next values on the way in, read now and then; a coarse sensor has fewer, and rests on each
OFTENER: Final = 8.0  # times as often as any of them: noise and the top of a wave come to 3
GOES_ON: Final = 0.05  # of the motor's way in the run, meanwhile: a torque that is held rests with its motor
MOST: Final = 0.05  # of the rows: of a course without its tops no more is left than a bias


@dataclass(frozen=True)
class AtTheEnd:
    """One end of a range: the reading there, and how many of the rows say it."""

    value: float
    count: int


def ends(x: Array, theta_m: Array | None) -> list[AtTheEnd]:
    """Where `x`, (n,), ends: at its largest value, its smallest, both or none; `theta_m` rad, (n,), or None."""
    if theta_m is None or not _often(x):
        return []
    found = np.unique(np.concatenate([_outermost(x[some]) for some in stretches(x.size)]))
    if found.size <= 2 * LEVELS:
        return []
    return [
        AtTheEnd(float(levels[0]), count)
        for levels in (found[: LEVELS + 1], found[::-1][: LEVELS + 1])
        if (count := _held(x, levels, theta_m))
    ]


def at_ends(x: Array, found: list[AtTheEnd]) -> npt.NDArray[np.int64]:
    """Rows of `x`, (n,), that say one of the ends."""
    values = [end.value for end in found]
    return np.concatenate([some.start + np.flatnonzero(np.isin(x[some], values)) for some in stretches(x.size)])


def _often(x: Array) -> bool:
    """Whether the largest or the smallest value of `x` is read often: sorting the rest of a long run takes longer."""
    there = [some for some in stretches(x.size) if np.isfinite(x[some]).any()]
    sides = [op([op(x[some]) for some in there]) for op in (np.nanmin, np.nanmax)] if there else []
    return any(sum(int(np.count_nonzero(x[s] == v)) for s in there) >= max(FEWEST, SHARE * x.size) for v in sides)


def _outermost(x: Array) -> Array:
    """The smallest and the largest values of some rows, as many as are looked at."""
    levels = np.unique(x[np.isfinite(x)])
    return np.concatenate([levels[: LEVELS + 1], levels[-LEVELS - 1 :]])


def _held(x: Array, levels: Array, theta_m: Array) -> int:
    """How many rows say `levels[0]`, 0 where that is no end: the next levels are read as often, or the motor rests."""
    counts = np.array([sum(int(np.count_nonzero(x[s] == level)) for s in stretches(x.size)) for level in levels])
    if counts[0] < max(FEWEST, SHARE * x.size) or counts[0] < OFTENER * counts[1:].max():
        return 0
    there = np.concatenate([theta_m[some][x[some] == levels[0]] for some in stretches(x.size)])
    way = float(np.nanmax(theta_m) - np.nanmin(theta_m))
    there = there[np.isfinite(there)]
    return int(counts[0]) if there.size and float(np.ptp(there)) > GOES_ON * way else 0
