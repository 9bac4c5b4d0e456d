"""What makes repeats differ and yet can be foretold: it is in the floor, and so never above it.

A room that warms and cools moves an encoder's mount in one run up and in its repeat down; a cable pulls otherwise where
a run begins a few turns on. Against what neighbouring turns of one run differ by it is large; and what is read in the
fitted runs foretells the others, as no wander does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.neighbours import neighbours
from rig.analysis.tracing.rest.binned import solved
from rig.analysis.tracing.rest.foretold import unseen_beside
from rig.analysis.tracing.rest.home import Home
from rig.analysis.tracing.rest.joined import Rest, rest
from rig.analysis.tracing.rest.lines import SENSES, SLOWEST
from rig.analysis.tracing.rest.readings import Reading, in_columns, nothing, powers, waves
from rig.analysis.tracing.thresholds import FORETOLD, PLAIN_ENOUGH, WANDERS
from rig.core.units import TURN
from rig.model.effect import Array

TWICE: Final = 2.0  # periods at least within the campaign: less is a trend, as gains and zeros have it
FINE: Final = 8  # frequencies tried for every whole wave more in the campaign
MOST: Final = 20_000  # of them: eight hours; each costs a fit
HARMONICS: Final = 3  # of its frequency: a brake that is on for a third of the time has as many
FEWEST: Final = 4  # runs
LARGEST: Final = 2.0  # order of a two-lobed wave generator, the largest of its kinematic error
BESIDE_ZEROS: Final = 0.05  # of the square of the floor: less than that zeros of runs may leave by chance
ALIKE: Final = 1.5  # highest over lowest speed of runs that are told by each other

SWINGS: Final[Sequence[Callable[[Rest], Array]]] = (
    lambda r: _scaled(r.at["speed"]),
    lambda r: _scaled(r.at["load"]),
    lambda r: waves(r.at["motor_angle"], LARGEST),
)
"""What a wave may multiply besides, (n,) or (n, k): drag by the speed, a spring by the torque, the kinematic error."""


def in_the_floor(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], floors: Mapping[Key, float]
) -> Home | None:
    """The wave of the campaign's time, or the way the output has gone, that the fitted runs show and the held-out ones
    follow; None where there is none.

    `fitted`, `unseen`: residuals (n,) by block; `floors` of all of them.
    """
    found = [_in_channel(eq, fitted, unseen, floors, channel) for channel in WHOLE]
    return max((home for home in found if home is not None), key=lambda home: home.share, default=None)


def _in_channel(
    eq: Equations,
    fitted: Mapping[Key, Array],
    unseen: Mapping[Key, Array],
    floors: Mapping[Key, float],
    channel: str,
) -> Home | None:
    still = _within_runs(eq, fitted, floors, channel)
    keys = [key for key in unseen if key[1] == channel]
    if not still or not keys:
        return None
    before, n = square(unseen, still, keys)
    if before < n * WANDERS**2:  # most campaigns: nothing has to be joined for them
        return None
    train = rest(eq, fitted, still, channel)
    if train is None or np.unique(train.run).size < FEWEST:
        return None
    beside = unseen_beside(eq, fitted, unseen, still, channel)

    def foretold(home: Home) -> float:
        after, _ = square(beside.without(home), still, keys)
        return (before - max(after, n)) / (before - n)

    bare = foretold(Home("time", channel, 0.0, read=in_columns(nothing)))
    homes = [replace(home, share=foretold(home) - bare) for home in _readings(train, channel)]
    best = max(homes, key=lambda home: home.share, default=None)
    if best is None or best.share > FORETOLD:
        return best
    left = 1 - bare  # zeros of runs follow a wave that is slower than they are long, and leave little of it
    nearly_all = best.share > PLAIN_ENOUGH * left and left * (before - n) > BESIDE_ZEROS * n
    return replace(best, share=best.share / left) if nearly_all else None


def _readings(train: Rest, channel: str) -> list[Home]:
    waved = [_waves(train, sense) for sense in (*SENSES, *SWINGS)] if train.timed else []
    homes = [Home("time_periodic", channel, 0.0, frequency_hz=w[1], read=w[0]) for w in waved if w is not None]
    if np.isfinite(train.at["load_angle"]).all():
        homes.append(Home("load_angle", channel, 0.0, read=in_columns(lambda r: powers(r.at["load_angle"]))))
    return [replace(home, own_zeros=train.own_zeros) for home in homes]


def _within_runs(
    eq: Equations, fitted: Mapping[Key, Array], floors: Mapping[Key, float], channel: str
) -> dict[Key, float]:
    """Floors with what differs from turn to turn within runs in the place of what differs from repeat to repeat."""
    mine = [key for key in fitted if key[1] == channel]
    seen = {key: s.rms / floors[key] for key in mine if (s := neighbours(eq, fitted, key))}
    if not seen:
        return {}

    def by(run: int) -> float:
        speed = eq.runs[run].turning
        like = [r for (i, _), r in seen.items() if speed / ALIKE < eq.runs[i].turning < speed * ALIKE]
        return min(1.0, float(np.median(like or [*seen.values()])))

    return {key: floor * by(key[0]) for key, floor in floors.items() if key[1] == channel}


def _waves(r: Rest, sense: Callable[[Rest], Array]) -> tuple[Reading, float] | None:
    """The reading of the wave that explains most against the `sense` of the motion, and its frequency, Hz; None where
    the campaign is too short for two of them, or lasts for days."""
    t, run, e, way = _by_seconds(r, _wide(sense(r)))
    slow = np.ones(run.size) if r.own_zeros else np.zeros(run.size)
    runs = (run[:, None] == np.unique(run)) * slow[:, None]

    def without_zeros(x: Array) -> Array:
        return np.asarray(x - runs @ (runs.T @ x / np.maximum(runs.sum(0), 1.0).reshape(-1, *[1] * (x.ndim - 1))))

    step = 1.0 / max(float(np.ptp(t)), 1e-9) / FINE
    if not TWICE * FINE < SLOWEST / step < MOST:
        return None
    tried = np.arange(TWICE * FINE * step, SLOWEST, step)
    y = without_zeros(e)
    tall = [_explained(without_zeros(_times(waves(TURN * t, f), way)), y) for f in tried]
    best = float(tried[int(np.argmax(tall))])

    def columns(rest: Rest) -> Array:
        time = TURN * rest.at["time"]
        made = np.hstack([waves(time, k * best) for k in range(1, HARMONICS + 1)])
        return _times(made, _wide(sense(rest)))

    return in_columns(columns), best


def _wide(x: Array) -> Array:
    """(n, k) of (n,) or (n, k)."""
    return x.reshape(x.shape[0], -1)


def _times(a: Array, b: Array) -> Array:
    """All products of the columns of two, (n, k·m)."""
    return np.asarray((a[:, :, None] * b[:, None, :]).reshape(a.shape[0], -1))


def _scaled(x: Array) -> Array:
    """Over its largest, 0 where it is unknown."""
    known = np.nan_to_num(x)
    return np.asarray(known / max(float(np.max(np.abs(known), initial=0.0)), 1e-9))


def _by_seconds(r: Rest, way: Array) -> tuple[Array, Array, Array, Array]:
    """Time, run, rest and `way` (n, k), means over seconds of a run."""
    second = np.floor(r.at["time"]).astype(int)
    _, first, place = np.unique(second * (1 + r.run.max()) + r.run, return_index=True, return_inverse=True)
    count = np.bincount(place)
    t, e, *w = (np.bincount(place, x) / count for x in (r.at["time"], r.e, *way.T))
    return t, r.run[first], e, np.stack(w, 1)


def _explained(z: Array, y: Array) -> float:
    """Sum of squares of `y` (n,) that columns `z` (n, k) explain."""
    return float((z.T @ y) @ solved(z.T @ z, z.T @ y))


def square(e: Mapping[Key, Array], floors: Mapping[Key, float], keys: Sequence[Key]) -> tuple[float, int]:
    return float(sum(e[k] @ e[k] / floors[k] ** 2 for k in keys)), sum(e[k].size for k in keys)
