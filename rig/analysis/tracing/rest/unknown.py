"""Where the rest lives when no effect of the library explains it: a coordinate, an order, a frequency; no name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.rest.binned import Halves, score
from rig.analysis.tracing.rest.coordinates import INDICES, JOINT, LATE, both, turned
from rig.analysis.tracing.rest.joined import Index, Rest, rest
from rig.analysis.tracing.rest.readings import Reading, drifting, in_bins, in_columns, means, powers, swelling, waves
from rig.analysis.tracing.thresholds import PLAIN_ENOUGH
from rig.model.effect import Array

TURN = 2 * np.pi
LOWEST = 0.8  # Hz of a line; a slow run's motor turns every six seconds
FINEST = {"motor_angle": (0.001, 0.02), "load_angle": (0.02, 1.0)}  # orders apart: half a cycle over all the turns
HIGHEST = {"motor_angle": 130.0, "load_angle": 400.0}  # order
AS_WELL = 0.98  # of its height the whole order beside it must have to be said instead
NEAR = 41  # orders tried beside the best one of the grid: to a fortieth of a cycle in all
MOST = 40_000  # rows that coordinates are tried on: of a bin in five hundred there are eighty
SLOWEST = 1 / 12.0  # Hz of what comes and goes by the clock: some times in the shortest of runs
STEP = 1 / (32 * LOWEST)  # s: a sixteenth of the shortest period
PHASES = 30  # of its period


@dataclass(frozen=True)
class Home:
    """A coordinate the rest lives in: the share of the excess it predicts in rows it was not fitted to."""

    coordinate: str
    channel: str
    share: float
    order: float | None = None  # cycles per turn
    frequency_hz: float | None = None
    read: Reading | None = None  # how it was read; none for a line
    own_zeros: bool = True  # whether every run had a zero of its own beside it
    late: bool = False  # said only where no plainer one does nearly as well


def homes(r: Rest, channel: str) -> list[Home]:
    """Coordinates by the share of the excess they predict, best first. Rows are fitted and tested on turn about."""
    line, r = _line(r, channel), r.thinned(MOST)
    h = Halves(r, folds(r))
    ways = [(name, index) for name, index in INDICES.items()]
    ways += [(name, index) for name, several in JOINT.items() for index in several]
    out = [Home(name, channel, score(h, of(r)) / h.total, read=in_bins(of)) for name, of in ways]
    out += [Home(name, channel, score(h, of(r)) / h.total, read=in_bins(of), late=True) for name, of in LATE]
    out += [Home(name, channel, _share(h, in_columns(of)), read=in_columns(of), late=True) for name, of in SMOOTH]
    some = [_best_order(h, name, channel, sense) for name in ("motor_angle", "load_angle") for sense in SENSES]
    out += [found for found in (*some, line, _wound(h, channel)) if found is not None]
    out += [_by_the_day(h, channel), *(_by_the_clock(h, channel, sense) for sense in SENSES)]
    return [replace(found, own_zeros=r.own_zeros) for found in sorted(out, key=lambda found: -found.share)]


def folds(r: Rest) -> Array:
    """0 and 1 in turn, stretches of 2 s: long against correlation, short against everything that drifts."""
    return np.asarray((r.at["time"] // 2.0).astype(int) % 2)


def _best_order(h: Halves, name: str, channel: str, sense: Callable[[Rest], Array]) -> Home | None:
    """One harmonic of an angle, order free, against the `sense` of the motion: its share on the other fold."""
    r = h.rest
    x = r.at[name]
    good = np.isfinite(x)
    if not good.any():
        return None
    x, e = x[good], (r.e * sense(r))[good]
    turns = float(np.ptp(x)) / TURN
    step = float(np.clip(0.5 / max(turns, 1.0), *FINEST[name]))
    rough = np.arange(max(0.5, step), HIGHEST[name], step)
    power = spectrum(x, e, rough)
    fine = _sharpened(x, e, float(rough[int(np.argmax(power))]), step)
    near = np.array([fine, max(round(fine), 1)])
    k = float(near[1] if np.divide(*_height(x, e, near)) < 1 / AS_WELL else fine)
    read = in_columns(lambda rest: waves(rest.at[name], k) * sense(rest)[:, None])
    return Home(name, channel, _share(h, read), order=k, read=read)


def _sharpened(x: Array, e: Array, order: float, step: float) -> float:
    """The order of a line that is known to one step of a grid, whose phase would be lost over all the turns."""
    near = order + step * np.linspace(-1.0, 1.0, NEAR)
    return float(near[int(np.argmax(_height(x, e, near)))])


def _height(x: Array, e: Array, orders: Array) -> Array:
    """Of a line at each of a few orders, (orders,)."""
    return np.abs([np.exp(-1j * k * x) @ e for k in orders])


def _share(h: Halves, read: Reading) -> float:
    """Of the excess, what each fold foretells of the other beyond what zeros alone do."""
    r, gain = h.rest, 0.0
    for test in (0, 1):
        seen = h.fold == test
        e = r.e - (means(r, ~seen) if r.own_zeros else 0.0)
        gain += float(np.sum(e[seen] ** 2 - (e - read(r, ~seen))[seen] ** 2))
    return gain / max(r.e.size, 1) / h.total


def spectrum(x: Array, e: Array, orders: Array) -> Array:
    """|Σ e·exp(−i·k·x)|² for orders on a uniform grid, rows counted into fine bins of x first; (orders,)."""
    step = float(orders[1] - orders[0])
    period = TURN / step
    size = 2 ** int(np.ceil(np.log2(4 * orders[-1] / step)))
    binned = np.bincount((np.mod(x, period) / period * size).astype(int) % size, e, minlength=size)
    lines = np.abs(np.fft.rfft(binned)) ** 2
    return np.asarray(lines[np.round(orders / step).astype(int)])


def _line(r: Rest, channel: str) -> Home | None:
    """A frequency that stands out in runs of differing speed; what is slower comes and goes with the motion."""
    hits: dict[int, list[tuple[float, float, float]]] = {}
    for run in np.unique(r.run):
        e, mine = r.e[r.run == run], r.run == run
        if e.size < 512:
            continue
        power = np.abs(np.fft.rfft(e * np.hanning(e.size))) ** 2
        hz = np.fft.rfftfreq(e.size, r.dt)
        slow = max(3, int(np.searchsorted(hz, LOWEST)))
        top = int(np.argmax(power[slow:])) + slow
        speed = float(np.mean(np.abs(r.at["speed"][mine])))
        near = slice(max(0, top - 3), top + 4)
        hits.setdefault(round(hz[top] * 5), []).append((hz[top], speed, float(power[near].sum() / power.sum())))
    best = max(hits.values(), key=len, default=[])
    speeds = np.array([s for _, s, _ in best])
    if len(best) < 3 or speeds.max() < 1.5 * speeds.min():
        return None
    share = float(np.mean([s for _, _, s in best])) * len(best) / max(1, np.unique(r.run).size)
    return Home("time_periodic", channel, share, frequency_hz=float(np.median([f for f, _, _ in best])))


def _by_the_clock(h: Halves, channel: str, sense: Callable[[Rest], Array]) -> Home:
    """What comes and goes with the time, of any form that all runs share: a pump, or a brake that rubs against the
    `sense` of the motion. Every run has a phase of its own, as clocks that are read to the second leave it.
    """
    r = h.rest
    t, e = r.at["time"], r.e * sense(r)
    size = int(4 * _longest(r) / STEP)  # to a quarter of what the longest run can tell apart
    hz = np.fft.rfftfreq(size, STEP)
    power = np.zeros(hz.size)
    for run in np.unique(r.run):
        power += np.abs(np.fft.rfft(_stepped(t[r.run == run], e[r.run == run]), size)) ** 2
    f = float(hz[int(np.argmax(np.where((hz >= SLOWEST) & (hz < 2 * LOWEST), power, 0.0)))])

    def phase(rest: Rest) -> Index:
        own, signed = np.zeros(rest.e.size), rest.e * sense(rest)
        for run in np.unique(rest.run):
            mine = rest.run == run
            own[mine] = _phase(rest.at["time"][mine], signed[mine], f)
        return both(turned(TURN * f * rest.at["time"] + own, PHASES), (sense(rest) + 1).astype(int))

    share = score(h, phase(r)) / h.total
    return Home("time_periodic", channel, share, frequency_hz=f, read=in_bins(phase))


SMOOTH: Sequence[tuple[str, Callable[[Rest], Array]]] = (
    ("speed", lambda r: swelling(r.at["motor_angle"], np.abs(r.at["speed"]))),
    ("load", lambda r: swelling(r.at["motor_angle"], r.at["load"])),
    ("time", lambda r: drifting(r.at["time"])),
)
"""Smooth laws where bins would tell single runs apart."""
SENSES: Sequence[Callable[[Rest], Array]] = (lambda r: np.ones(r.e.size), lambda r: r.at["direction"])


def _longest(r: Rest) -> float:
    """Of the runs, s."""
    return max(float(np.ptp(r.at["time"][r.run == run])) for run in np.unique(r.run)) + r.dt


def _by_the_day(h: Halves, channel: str) -> Home:
    """A wave of the campaign's own time, slower than a run shows by itself: a room that warms and cools."""
    r = h.rest
    x = TURN * r.at["time"]
    step = 0.25 * TURN / float(np.ptp(x))
    rough = np.arange(step, SLOWEST, step)
    f = _sharpened(x, r.e, float(rough[int(np.argmax(spectrum(x, r.e, rough)))]), step)
    read = in_columns(lambda rest: waves(TURN * rest.at["time"], f))
    return Home("time_periodic", channel, _share(h, read), frequency_hz=f, read=read, late=True)


def _stepped(t: Array, e: Array) -> Array:
    """Mean of the rows of one run in each step of time, about their mean; 0 where there are none."""
    place = ((t - t[0]) / STEP).astype(int)
    count = np.bincount(place)
    mean = np.bincount(place, e) / np.maximum(count, 1)
    return np.where(count > 0, mean - mean[count > 0].mean(), 0.0)


def _phase(t: Array, e: Array, f: float) -> float:
    """Of the wave of `f` Hz in one run, rad at time 0."""
    mean = _stepped(t, e)
    at = t[0] + STEP * (np.arange(mean.size) + 0.5)
    return float(np.angle(np.exp(-1j * TURN * f * at) @ mean))


def _wound(h: Halves, channel: str) -> Home | None:
    """The output angle gone since the run began, which does not come round: a cable winds up. Said late: in runs of
    constant speed it is the speed and the time as well."""
    if not np.isfinite(h.rest.at["load_angle"]).all():
        return None
    read = in_columns(lambda rest: powers(rest.at["load_angle"]))
    return Home("load_angle", channel, _share(h, read), read=read, late=True)


def home(eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float]) -> list[Home]:
    """Best coordinates of the channel with the most left."""
    parts = [(c, r) for c in CHANNELS if (r := rest(eq, e, floors, c)) is not None]
    channel, most = max(parts, key=lambda p: float(np.mean(p[1].e ** 2)))
    found = homes(most, channel)
    if channel == "L":  # its zero may wander from run to run, or a gain does that only loads of several runs show
        found += homes(replace(most, own_zeros=False), channel)
    return plainest(found)


def plainest(found: Sequence[Home]) -> list[Home]:
    """The best first, and before it simpler ones that do nearly as well."""
    best = max(h.share for h in found)
    return sorted(found, key=lambda h: (h.share < PLAIN_ENOUGH * best, h.late, SIMPLE.index(h.coordinate), -h.share))


SIMPLE: Sequence[str] = (
    "direction",
    "time_periodic",
    "motor_angle",
    "load_angle",
    "speed",
    "load",
    "memory",
    "temperature",
    "time",
)


def smooth_term(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], floors: Mapping[Key, float], found: Home
) -> dict[Key, Array]:
    """Held-out residuals without what that coordinate foretells, as read in the fitted runs, and without zeros that are
    their own beside it."""
    out = dict(unseen)
    train, test = rest(eq, fitted, floors, found.channel), rest(eq, unseen, floors, found.channel)
    if train is None or test is None:
        return out
    both = Rest(
        np.concatenate([train.e, test.e]),
        np.concatenate([train.run, test.run]),
        {k: np.concatenate([train.at[k], test.at[k]]) for k in train.at},
        train.dt,
        np.concatenate([train.z, test.z]),
        train.known,
        found.own_zeros,
    )
    if found.read is None:
        return out
    guess = found.read(both, np.arange(both.e.size) < train.e.size)[train.e.size :]
    start = 0
    for key in [k for k in unseen if k[1] == found.channel]:
        n = unseen[key].size
        left = unseen[key] - eq.bare(key, guess[start : start + n]) * floors[key]
        out[key] = left - np.mean(left) if found.own_zeros else left
        start += n
    return out
