"""What makes repeats differ and yet can be foretold: it is in the floor, and so never above it.

A room that warms and cools moves an encoder's mount in one run up and in its repeat down; a cable pulls otherwise where
a run begins a few turns on. Against what neighbouring turns of one run differ by it is large; and what is read in the
fitted runs foretells the others, as no wander does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.neighbours import neighbours
from rig.analysis.tracing.residual.binned import solved
from rig.analysis.tracing.residual.foretold import unseen_beside
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Rest, rest
from rig.analysis.tracing.residual.lines import SENSES, SLOWEST, longest
from rig.analysis.tracing.residual.products import times
from rig.analysis.tracing.residual.readings import Reading, in_columns, nothing, powers, waves
from rig.analysis.tracing.thresholds import FORETOLD, PLAIN_ENOUGH, WANDERS
from rig.core.units import TURN
from rig.model.effect import Array

TWICE: Final = 2.0  # periods at least within the campaign: less is a trend, as gains and zeros have it
FINE: Final = 8  # frequencies tried for every whole wave more in the campaign
MOST: Final = 20_000  # of them: eight hours; each costs a fit
FASTEST: Final = 0.8  # Hz; what is faster is a line in every run by itself
OFTEN: Final = 8.0  # means a second at which what comes and goes faster than the slow ones is sought
PEAKS: Final = 30  # of its spectrum that are looked at
NEAR: Final = 9  # frequencies tried about the one that is found
HARMONICS: Final = 5  # of its frequency: what is filled at once and runs down has as many
FEWEST: Final = 4  # runs
LARGEST: Final = 2.0  # order of a two-lobed wave generator, the largest of its kinematic error
BESIDE_ZEROS: Final = 0.05  # of the square of the floor: less than that zeros of runs may leave by chance
SLOW_FORETOLD: Final = (
    0.6  # scattering friction had 0.54 and 0.57 (902 and 519 s); ten right ones of 6 to 98 s 0.66 and more
)
ONCE: Final = 0.1  # of a turn, by which a wave may miss it
IN_STEP: Final = 0.9  # length of the mean of their unit vectors: a tenth of a turn about it
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


def as_runs_begin(eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float], wave: Home) -> bool:
    """Whether a `wave` goes once round between neighbours of the runs that have most of what is left, and is at the
    same point whenever one begins: what each of them does anew does so too, and needs no clock (exam 94, case 30)."""
    keys = [key for key in e if key[1] == wave.channel]
    if len(keys) < FEWEST or not wave.frequency_hz:
        return False
    square = np.array([np.mean((e[key] / floors[key]) ** 2) for key in keys])
    begun = np.array([eq.runs[key[0]].start for key in keys])
    most = square > square.mean()
    if np.sum(most) < FEWEST:
        return False
    apart = np.diff(np.sort(begun[most])).min()
    at = np.average(np.exp(1j * TURN * wave.frequency_hz * begun[most]), weights=square[most])
    return bool(abs(wave.frequency_hz * apart - 1.0) < ONCE and abs(at) > IN_STEP)


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
        after, _ = square(beside.without(home).unseen, still, keys)
        return (before - max(after, n)) / (before - n)

    bare = foretold(Home("time", channel, 0.0, read=in_columns(nothing)))
    homes = [replace(home, share=foretold(home) - bare) for home in _readings(train, channel)]
    best = max(homes, key=lambda home: home.share, default=None)
    if best is None or best.share > _enough(best, train):
        return best
    left = 1 - bare  # zeros of runs follow a wave that is slower than they are long, and leave little of it
    nearly_all = best.share > PLAIN_ENOUGH * left and left * (before - n) > BESIDE_ZEROS * n
    return replace(best, share=best.share / left) if nearly_all else None


def _enough(home: Home, train: Rest) -> float:
    """The share that must be foretold. A wave that is slower than any run is long is told by one number of each run, of
    which it has a dozen of its own: friction that scatters from run to run is foretold to half by chance."""
    is_slow = home.frequency_hz is not None and home.frequency_hz * longest(train) < 1.0
    return SLOW_FORETOLD if is_slow else FORETOLD


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
    way = _wide(sense(r))
    slow = _Means.of(r, way, 1.0)
    step = 1.0 / max(float(np.ptp(slow.t)), 1e-9) / FINE
    if not TWICE * FINE < SLOWEST / step < MOST:
        return None
    fast = _Means.of(r, way, OFTEN)
    tried = [(slow.explained(f), f) for f in np.arange(TWICE * FINE * step, SLOWEST, step).tolist()]
    best: float = max(tried + [(fast.explained(f), f) for f in fast.loudest(step)])[1]
    means = slow if best < SLOWEST else fast
    near = np.linspace(best - step, best + step, NEAR).tolist()
    best = max((means.explained(f, HARMONICS), f) for f in near)[1]  # an overtone would be a radian out by the end

    def columns(rest: Rest) -> Array:
        return times(overtones(rest.at["time"], best, HARMONICS), _wide(sense(rest)))

    return in_columns(columns), best


@dataclass(frozen=True)
class _Means:
    """Time [s], rest without the zeros of runs that have their own, and the sense (n, k): means over an equal
    time. And those zeros' columns (n, runs), and rows in a mean."""

    t: Array
    e: Array
    way: Array
    zeros: Array
    rows: float

    @classmethod
    def of(cls, r: Rest, way: Array, often: float) -> _Means:
        """`often` a second, of the sense `way` (n, k)."""
        place = np.floor(often * r.at["time"]).astype(int)
        _, first, place = np.unique(place * (1 + r.run.max()) + r.run, return_index=True, return_inverse=True)
        count = np.bincount(place)
        t, e, *w = (np.bincount(place, x) / count for x in (r.at["time"], r.e, *way.T))
        run = r.run[first]
        own = np.ones(run.size) if r.own_zeros else np.zeros(run.size)
        runs = (run[:, None] == np.unique(run)) * own[:, None]
        bare = cls(t, e, np.stack(w, 1), runs, r.e.size / t.size)
        return replace(bare, e=bare._without_zeros(e))

    def explained(self, hz: float, harmonics: int = 1) -> float:
        """Sum of squares of rows that a wave of that frequency explains, and its overtones up to so many of them."""
        z = self._without_zeros(times(overtones(self.t, hz, harmonics), self.way))
        return _explained(z, self.e) * self.rows

    def loudest(self, step: float) -> list[float]:
        """Frequencies in Hz, `step` apart, from SLOWEST to FASTEST at which the rest has most against the sense."""
        even = np.round((self.t - self.t[0]) * OFTEN).astype(int)
        size = max(round(OFTEN / step), even[-1] + 1)
        laid = np.zeros((self.way.shape[1], size))
        laid[:, even] = (self.e[:, None] * self.way).T
        power = (np.abs(np.fft.rfft(laid)) ** 2).sum(0)
        hz = np.fft.rfftfreq(size, 1 / OFTEN)
        top = np.flatnonzero((power[1:-1] >= power[:-2]) & (power[1:-1] > power[2:])) + 1
        top = top[(hz[top] >= SLOWEST) & (hz[top] < FASTEST)]
        return [float(hz[i]) for i in top[np.argsort(-power[top])][:PEAKS]]

    def _without_zeros(self, x: Array) -> Array:
        made = self.zeros
        return np.asarray(x - made @ (made.T @ x / np.maximum(made.sum(0), 1.0).reshape(-1, *[1] * (x.ndim - 1))))


def overtones(t: Array, hz: float, harmonics: int) -> Array:
    """Cosine and sine of a wave and its overtones at times [s], (n, 2·harmonics)."""
    return np.hstack([waves(TURN * t, k * hz) for k in range(1, harmonics + 1)])


def _wide(x: Array) -> Array:
    """(n, k) of (n,) or (n, k)."""
    return x.reshape(x.shape[0], -1)


def _scaled(x: Array) -> Array:
    """Over its largest, 0 where it is unknown."""
    known = np.nan_to_num(x)
    return np.asarray(known / max(float(np.max(np.abs(known), initial=0.0)), 1e-9))


def _explained(z: Array, y: Array) -> float:
    """Sum of squares of `y` (n,) that columns `z` (n, k) explain."""
    return float((z.T @ y) @ solved(z.T @ z, z.T @ y))


def square(e: Mapping[Key, Array], floors: Mapping[Key, float], keys: Sequence[Key]) -> tuple[float, int]:
    return float(sum(e[k] @ e[k] / floors[k] ** 2 for k in keys)), sum(e[k].size for k in keys)
