"""A line that stands beside the motion, steady or wandering: it makes repeats differ, so the floor hides it.

It is sought window by window, for a wandering line is narrow only for a few seconds, and told from orders of a shaft by
its frequency, which does not follow the speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.floor.spectrum import on_even_grid
from rig.analysis.tracing.thresholds import LINE, LINE_FREE, LINE_RUNS, LINE_WIDE, LOUD_LINE
from rig.core.units import TURN
from rig.model.effect import Array
from rig.model.linear import held_frequency
from rig.process.workers import each

LOWEST = 0.8  # Hz; below, a run of 10 s cannot tell a line from drift
WINDOW = 4.0  # s: a quarter of a hertz; what wanders by a tenth in a minute stays inside
PADDED = 4  # finer than a window's own resolution
LEAP = 0.1  # relative: half a window on, a line that wanders by a fifth in a minute has gone a hundredth
AROUND = 3.0  # times a frequency, and a third of it: its neighbourhood
FEWEST = 3  # windows of a run, each half over the next
WANDERS = 1.25  # highest over lowest within every run: a resonance that rings is narrower
EVEN = 1.1  # the same of the speed of a run that turns evenly
STEADY = 1.02  # highest over lowest: a sixteenth of a hertz is how finely a window is read
WHOLE_ORDERS = 0.7  # of the runs in which a line that wanders is a whole order of the motor: chance makes a tenth
WHOLE_BY = 0.05  # of a turn: as near to one as a window reads a frequency at 75 rpm
RINGING = 1.5  # times the gear's own resonance, and as much below: what wanders there is the gear, of a wrong inertia
SHORTEST = 4 / LOWEST / 2  # s: two periods of the slowest line


@dataclass(frozen=True)
class Interference:
    """Usual frequency, how far runs lie apart (highest over lowest), RMS over all of the residual, the line itself in
    every block it was read in, (n, 1), and whether the shaft's torque was read, which tells what shakes the load."""

    channel: str
    frequency_hz: float
    apart: float
    share: float
    columns: dict[Key, Array]
    torque_read: bool = True

    def sentence(self) -> str:
        """What it is and is not."""
        wanders = f", from run to run {100 * (self.apart - 1):.0f} % apart" if self.apart > STEADY else ""
        whose = "no torque on the load makes it: a pick-up in a sensor is likely"
        if not self.torque_read:
            whose = "without a torque sensor nobody can tell whether a torque on the load makes it or a pick-up"
        return (
            f"A line at {self.frequency_hz:.2f} Hz{wanders} stands in the data whatever the speed, "
            f"{min(self.share, 1.0):.0%} of what the model leaves there, and {whose}. "
            "It makes repeats differ, so the floors were measured without it."
        )


@dataclass(frozen=True)
class _Track:
    """One run: frequency and height over its surroundings, window by window."""

    hz: Array
    height: Array

    @property
    def wander(self) -> float:
        """Highest over lowest frequency, but for a tenth of the windows at each end: no order of a shaft that turns
        evenly has any, and no resonance much of it."""
        low, high = np.quantile(self.hz[self.height > LINE], [0.1, 0.9])
        return float(high / low)

    @property
    def leaps(self) -> float:
        """How far it usually is from one window to the next, relative: noise of a broad hump has its top anywhere."""
        return float(np.median(np.abs(np.diff(np.log(self.hz[self.height > LINE])))))


def find_interference(eq: Equations, e: Mapping[Key, Array], unseen: Mapping[Key, Array]) -> Interference | None:
    """Sought in the fitted residuals `e` alone, then read in `unseen` too. A line in one sensor shows in every equation
    that uses it: the channel where it is loudest is the one told, all are rid of it.
    """
    keys = sorted((k for k in e if k[1] in WHOLE and not eq.runs[k[0]].locked), key=lambda k: -e[k].size)
    tracked = dict(zip(keys, each(lambda k: _track(*even_grid(eq, k, e[k])[:2]), keys), strict=True))
    tracks = {k: t for k in e if (t := tracked.get(k)) is not None}
    found = [line for c in WHOLE if (line := _in_channel(eq, e, unseen, c, tracks)) is not None]
    if not found:
        return None
    loudest = max(found, key=lambda line: line.share)
    read = any("tau_l" in run.has for run in eq.runs)
    return replace(loudest, columns={k: x for line in found for k, x in line.columns.items()}, torque_read=read)


def _in_channel(
    eq: Equations, e: Mapping[Key, Array], unseen: Mapping[Key, Array], channel: str, tracks: Mapping[Key, _Track]
) -> Interference | None:
    keys = [k for k in e if k[1] == channel and not eq.runs[k[0]].locked]
    tracks = {k: t for k, t in tracks.items() if k[1] == channel}
    hits = {k: t for k, t in tracks.items() if np.mean(t.height > LINE) > LINE_RUNS and t.leaps < LEAP}
    if len(hits) < 3 or len(hits) < LINE_RUNS * len(tracks):
        return None
    hz = np.array([np.median(t.hz[t.height > LINE]) for t in hits.values()])
    speed = np.array([eq.runs[i].turning for i, _ in hits])
    apart = float(hz.max() / hz.min())
    travels = all(t.wander > WANDERS and eq.runs[i].keeps_speed(EVEN) for (i, _), t in hits.items())
    if apart > LINE_WIDE or not (travels or speed.max() >= LINE_FREE * apart * speed.min()):
        return None
    usual = float(np.median(hz))
    as_gear = _are_orders(hz, speed) or abs(np.log(usual / _resonance(eq))) < np.log(RINGING)
    if apart > STEADY and as_gear and not travels:
        return None
    lines = {k: _line(eq, k, r, usual) for k, r in {**e, **unseen}.items() if k[1] == channel}
    loud = [(float(lines[k] @ lines[k]), float(e[k] @ e[k])) for k in keys]
    share = sum(a for a, _ in loud) / max(sum(b for _, b in loud), 1e-300)
    if share < LOUD_LINE:
        return None
    return Interference(channel, usual, apart, share, {k: x[:, None] for k, x in lines.items()})


def _are_orders(hz: Array, speed: Array) -> bool:
    """Whether the frequency (k,) is a whole order of the motor at `speed` [rad/s], (k,), another one in each run: those
    that come near a resonance stand out, and go with it."""
    order = hz / (speed / TURN)
    return bool(np.mean(np.abs(order - np.round(order)) < WHOLE_BY) > WHOLE_ORDERS)


def _resonance(eq: Equations) -> float:
    """Of the load on the spring, Hz, from what is known of the gear by now."""
    gear = eq.runs[0].gear
    return held_frequency(gear.K, gear.J_l) / (2 * np.pi)


def even_grid(eq: Equations, key: Key, e: Array) -> tuple[Array, float, npt.NDArray[np.int64]]:
    """The residual on an even grid (zero where a row is left out), its step [s], and the place of each row."""
    return on_even_grid(clock(eq, key), e)


def _track(even: Array, dt: float) -> _Track | None:
    n = min(int(WINDOW / dt), 2 * even.size // (FEWEST + 1))
    if n * dt < SHORTEST:
        return None
    start = np.arange(0, even.size - n + 1, n // 2)
    hz = np.fft.rfftfreq(PADDED * n, dt)
    band = hz > LOWEST
    power = _power(even, start, n)
    over = power[:, band] / np.maximum(around(power, hz, np.asarray(hz[band], float), 2 / (n * dt)), 1e-300)
    top = np.argmax(over, axis=1)
    return _Track(hz[band][top], over[np.arange(start.size), top])


def around(power: Array, hz: npt.NDArray[np.floating], at: Array, wide: float) -> Array:
    """Median power on that side of each frequency of `at` where there is more (windows, frequencies), from a third of
    it to `wide` Hz below, from as far above to three times it: friction that wanders has most of its power at the
    lowest frequencies, a low-pass leaves little at the highest, and neither is a line."""
    coarse = np.unique(np.round(np.geomspace(1, at.size, 60)).astype(int)) - 1
    sides = []
    for f in at[coarse]:
        edges = np.array([[f / AROUND, f - wide], [f + wide, f * AROUND]])
        bounds = zip(np.searchsorted(hz, edges[:, 0]), np.searchsorted(hz, edges[:, 1], side="right"), strict=True)
        found = [_median(power[:, lo:hi]) for lo, hi in bounds if hi > lo]
        sides.append(np.max(found, axis=0))
    nearest = np.searchsorted(coarse, np.arange(at.size)).clip(max=coarse.size - 1)
    return np.asarray(np.stack(sides, 1)[:, nearest])


def _median(x: Array) -> Array:
    """Of every row of (n, k), (n,), without the looks for NaN that take half of numpy's own, and with one place of each
    row found: for two at once numpy has no fast way."""
    middle = x.shape[1] // 2
    part = np.partition(x, middle, axis=1)
    upper = part[:, middle]
    lower = upper if x.shape[1] % 2 else part[:, :middle].max(axis=1)
    return np.asarray(0.5 * (lower + upper))


def _power(even: Array, start: npt.NDArray[np.int64], n: int) -> Array:
    """Of every window, (windows, bins)."""
    stretches = even[start[:, None] + np.arange(n)] * np.hanning(n)
    return np.asarray(np.abs(np.fft.rfft(stretches, PADDED * n, axis=1)) ** 2)


def _line(eq: Equations, key: Key, e: Array, about: float) -> Array:
    """The line in one run (n,): in every window the sinusoid that fits best near `about` Hz, windows faded into one
    another."""
    even, dt, place = even_grid(eq, key, e)
    n = min(int(WINDOW / dt), even.size)
    step = max(n // 2, 1)
    start = np.unique(np.append(np.arange(0, even.size - n + 1, step), even.size - n))
    hz = np.fft.rfftfreq(PADDED * n, dt)
    near = np.abs(np.log(np.maximum(hz, 1e-9) / about)) < np.log(LINE_WIDE)
    power = _power(even, start, n)
    best = hz[near][np.argmax(power[:, near], axis=1)]
    fade, out, weight = np.hanning(n + 2)[1:-1], np.zeros(even.size), np.full(even.size, 1e-12)
    x = np.arange(n) * dt
    for first, f in zip(start, best, strict=True):
        z = np.stack([np.cos(2 * np.pi * f * x), np.sin(2 * np.pi * f * x)], 1)
        c = np.linalg.lstsq(z * fade[:, None], even[first : first + n] * fade, rcond=None)[0]
        out[first : first + n] += fade * (z @ c)
        weight[first : first + n] += fade
    return np.asarray((out / weight)[place])
