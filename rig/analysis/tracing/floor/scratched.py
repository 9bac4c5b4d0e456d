"""A scratch on the load encoder's disc: counts are lost for good each time one place of it is passed one way.

Repeats jump at the same angle then, as over a tooth or a bad place of a scale. But what those do is gone once the place
is behind, or passed the other way, and lost counts stay: where a run comes by the same angles the same way before and
after such a jump, it is off by all of it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.steps import Steps
from rig.core.units import TURN
from rig.model.effect import Array

LARGE: Final = 0.5  # of the largest jump: smaller ones are what large ones leave in a fit that knows none
RUNS: Final = 3  # that jump
NEAR: Final = 0.02  # rad of the output from their usual place: rows of a fast run are half as far apart
MOST: Final = 0.9  # of the jumps that lie there, and go one way
PASSED: Final = 0.75  # of the times that place is passed that way, at which a run jumps
BINS: Final = 200  # of a turn of the output
SEEN: Final = 100  # rows that are told by others at the same angle, the same way, before or after a jump
STAYS: Final = (0.8, 1.25)  # times what a run is off by at the same angle after its jumps, over their sizes


def scratched(eq: Equations, e: Mapping[Key, Array], steps: Steps) -> Steps | None:
    """The large ones of those `steps` in `e`, where they are counts lost at one place; None where they are not."""
    large = _large(steps)
    if len(large.rows) < RUNS:
        return None
    theta = {run: eq.rows[run, "A"].theta_m / eq.runs[run].ratio for run in large.rows}
    at = np.concatenate([theta[run][list(rows)] for run, rows in large.rows.items()])
    ways = np.concatenate([_way(theta[run])[list(rows)] for run, rows in large.rows.items()])
    place, way = float(np.angle(np.mean(np.exp(1j * at)))), float(np.sign(ways.sum()))
    signs = np.sign(np.concatenate(list(large.sizes.values())))
    if min(np.mean(_apart(at, place) < NEAR), np.mean(ways == way), abs(np.mean(signs))) < MOST:
        return None
    times = sum(_times(eq.rows[i, "A"].theta_m / eq.runs[i].ratio, place, way) for i, c in e if c == "A")
    return large if at.size > PASSED * times and _stays(e, theta, large, place) else None


def _large(steps: Steps) -> Steps:
    """Those that are LARGE, in the runs that have some."""
    least = LARGE * max((abs(size) for sizes in steps.sizes.values() for size in sizes), default=np.inf)
    kept = {run: [i for i, size in enumerate(sizes) if abs(size) > least] for run, sizes in steps.sizes.items()}
    runs = [run for run, which in kept.items() if which]

    def of(each: Mapping[int, tuple[float, ...]]) -> dict[int, tuple[float, ...]]:
        return {run: tuple(each[run][i] for i in kept[run]) for run in runs}

    rows = {run: tuple(steps.rows[run][i] for i in kept[run]) for run in runs}
    return Steps(rows, of(steps.sizes), of(steps.sides), of(steps.errors))


def _apart(at: Array, place: float) -> Array:
    """Angles [rad] between those and the place, on a disc."""
    return np.asarray(np.abs(np.angle(np.exp(1j * (at - place)))))


def _way(theta: Array) -> Array:
    """Which way the output turns in each row, (n,)."""
    return np.asarray(np.sign(np.gradient(theta)))


def _times(theta: Array, place: float, way: float) -> int:
    """How often that place is passed that way, by more than NEAR on both sides."""
    before, after = (np.floor((theta - place - by) / TURN) for by in (NEAR * way, -NEAR * way))
    both: npt.NDArray[np.bool_] = np.diff(before) * way > 0
    return int(min(both.sum(), (np.diff(after) * way > 0).sum()))


def _stays(e: Mapping[Key, Array], theta: Mapping[int, Array], steps: Steps, place: float) -> bool:
    """Whether runs are off by the sizes of their jumps at angles that they come by the same way before and after. A run
    about zero ends where it began: bins lie beside each other in one way or another."""
    found = [_off(e, theta, steps, place, shift) for shift in (0.0, 0.5)]
    together, alone, seen = max(found, key=lambda one: one[2])
    least, most = STAYS
    return seen > SEEN and least < together / max(alone, 1e-300) < most


def _off(
    e: Mapping[Key, Array], theta: Mapping[int, Array], steps: Steps, place: float, shift: float
) -> tuple[float, float, int]:
    """Sums over rows of how far the jumps put them apart from others of their bin times how far they are, and of its
    square, and their number; bins `shift` of one further on."""
    together = alone = 0.0
    seen = 0
    for run, rows in steps.rows.items():
        off = _sum(rows, steps.sizes[run], theta[run].size)
        place_of = np.floor(np.mod(theta[run] + shift * TURN / BINS, TURN) / TURN * BINS).astype(int)
        bins = place_of * 2 + (_way(theta[run]) > 0)
        x, y = _about_their_means(off, bins), _about_their_means(e[run, "A"], bins)
        x = np.where(_apart(theta[run], place) > TURN / BINS + NEAR, x, 0.0)  # a bin that holds a jump is on both sides
        seen += int(np.sum(np.abs(x) > 0.0))
        together, alone = together + float(x @ y), alone + float(x @ x)
    return together, alone, seen


def _sum(rows: Sequence[int], sizes: Sequence[float], n: int) -> Array:
    """What all jumps before a row come to, (n,)."""
    out = np.zeros(n)
    for row, size in zip(rows, sizes, strict=True):
        out[row:] += size
    return out


def _about_their_means(x: Array, bins: npt.NDArray[np.int64]) -> Array:
    """`x` (n,) less the mean of its bin."""
    count = np.maximum(np.bincount(bins), 1)
    return np.asarray(x - (np.bincount(bins, x) / count)[bins])
