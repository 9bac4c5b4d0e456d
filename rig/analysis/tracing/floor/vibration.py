"""A torque on the load at frequencies of its own, whatever the speed: each run has its own phase."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key, Term
from rig.analysis.tracing.fit.model import Solution, design, fit
from rig.analysis.tracing.floor.local import clock, joined
from rig.analysis.tracing.floor.spectrum import on_even_grid, over_usual
from rig.analysis.tracing.thresholds import LINE, LINE_RUNS, LINE_SPEEDS, STRETCHES
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter, parameter
from rig.model.effects import EACH_RUN
from rig.model.effects.external_vibration import ExternalVibration

VIBRATION = EACH_RUN["external_vibration"]
LINES = 3  # of one vibration: one that swells and fades has two beside its own
STROKES = 10  # of one that comes in strokes, at whole multiples of how often
AS_ONE = 0.7  # an interference in one sensor alone has 0
CRYSTAL = 2e-5  # of a frequency: what the oscillator of a host's clock may be off      [vig1992]
STILL_THERE = 0.3  # of the mean size; of nine lines of vibrations in five campaigns 0.98 and more
SEVERAL = 6  # runs that a line over the speed is laid through
FEWEST = 3  # runs, or stretches of one, that a line is told by
SAME = 0.05  # Hz, half of what a run of 10 s resolves: two lines nearer than that are one


@dataclass(frozen=True)
class Line:
    """One frequency: amplitude by channel (median over runs), half the 95 % intervals of frequency and torque, and the
    torque itself. `as_one`: how much of it one torque on the load makes, in angle and motor torque alike. `at_rest`: as
    large as it is by the line over the speed, with its half width, where nothing turns, over its mean."""

    frequency_hz: float
    amplitude: dict[str, float]
    half_hz: float
    half_torque: float
    torque: float  # N·m
    as_one: float = 0.0
    at_rest: float = 1.0

    def of_the_load(self, stiffness: float) -> bool:
        """True for a torque on the load, of a size that is known; an interference in the torque sensor would wind the
        gear up in A too, and what a delay that swings makes of a turning angle is nothing at rest. Without one the
        torque shows in A and M, in the proportion that the gear's stiffness and ratio make."""
        if self.at_rest < STILL_THERE:
            return False
        if "L" not in self.amplitude:
            return self.as_one > AS_ONE
        torque = self.amplitude["L"]
        return torque > self.half_torque and self.amplitude.get("A", 0.0) < 0.5 * torque / stiffness


@dataclass(frozen=True)
class Vibration:
    """Lines at one frequency each in runs of differing speed, the loudest first, and their columns by block."""

    lines: tuple[Line, ...]
    columns: dict[Key, Array]

    def parameters(self) -> tuple[Parameter, ...]:
        """Frequency and amplitude of every line."""
        out = []
        for i, line in enumerate(self.lines):
            place = f"_{i + 1}" if i else ""
            out.append(parameter(f"frequency{place}", line.frequency_hz, line.half_hz, "Hz"))
            out.append(parameter(f"torque_amplitude{place}", line.torque, line.half_torque, "N·m"))
        return tuple(out)


def find_vibration(s: Solution, e: Mapping[Key, Array], runs: Sequence[int]) -> Vibration | None:
    """In the residuals `e` of a fit to `runs`; None where nothing shakes the load at a frequency of its own. A swelling
    one has more than one line, and one that comes in strokes has many."""
    eq, stiffness = s.design.eq, 1 / c if (c := s.value("compliance")) > 0 else np.inf
    found: tuple[Line, ...] = ()
    columns: dict[Key, Array] = {}
    left = dict(e)
    while len(found) < STROKES and (hz := _loudest(eq, left)) is not None:
        if any(abs(hz - line.frequency_hz) < SAME for line in found):
            break
        if len(found) >= LINES and not _in_strokes([hz, *(line.frequency_hz for line in found)]):
            break
        mine = vibration_columns(eq, hz)
        more = joined([columns, mine])
        # the inertia fitted without the vibration is off, and with it what is left of the wave
        beside = fit(design(_with(eq, more), s.design.terms, runs))
        bare = design(eq, s.design.terms, runs)
        line = _line(eq, {key: bare.residual(key, beside.x) for key in left}, mine, hz)
        if not line.of_the_load(stiffness):
            break
        found, columns = (*found, line), more
        left = {key: beside.residual(key) for key in left}
    return Vibration(found, columns) if found else None


def _in_strokes(hz: Sequence[float]) -> bool:
    """Whether all frequencies are whole multiples of how far the nearest two of them are apart."""
    order = np.sort(hz)
    often = float(np.diff(order).min())
    return often > 2 * SAME and bool(np.all(np.abs(order - often * np.round(order / often)) < SAME))


def _with(eq: Equations, columns: Mapping[Key, Array]) -> Equations:
    return replace(eq, own=joined([eq.own, columns]))


Part = tuple[Array, Array, float]
"""Times s and residuals (n,) of a run, or of a stretch of it, and how fast its motor turned, rad/s."""


def _parts(eq: Equations, key: Key, e: Array, count: int) -> list[Part]:
    """A run, or as many stretches of it: of one long log they are what several runs would be."""
    t, theta = clock(eq, key), eq.rows[key].theta_m
    if count == 1:
        return [(t, e, eq.runs[key[0]].turning)]
    rows = np.array_split(np.arange(e.size), count)
    turning = [float(np.abs(np.diff(theta[r])).sum() / max(np.ptp(t[r]), 1e-9)) for r in rows if r.size > 256]
    return [(t[r], e[r], speed) for r, speed in zip([r for r in rows if r.size > 256], turning, strict=True)]


def _loudest(eq: Equations, e: Mapping[Key, Array]) -> float | None:
    """Hz of the strongest line at a fixed frequency in L (in A without a torque sensor), None when there is none. Of
    each frequency the runs tell whose rows are dense enough: in slow ones a fast line stands where it is no line."""
    channel = "L" if any(c == "L" for _, c in e) else "A"
    keys = [k for k in e if k[1] == channel and e[k].size > 256]
    turning = [eq.runs[i].turning for i, _ in keys]
    # long runs that all go through the same speeds tell by their stretches
    whole = len(keys) >= FEWEST and max(turning) > LINE_SPEEDS * min(turning)
    parts = [part for key in keys for part in _parts(eq, key, e[key], 1 if whole else STRETCHES)]
    if len(parts) < FEWEST:
        return None
    tops = np.array([0.98 * 0.5 / float(np.median(np.diff(t))) for t, _, _ in parts])
    grid = np.arange(ExternalVibration.LOWEST, np.sort(tops)[-FEWEST], ExternalVibration.STEP)
    heights = np.array([_heights(t, x, grid) for t, x, _ in parts])
    heights[grid > tops[:, None]] = np.nan
    speed = np.array([turning for _, _, turning in parts])
    hits = heights > LINE
    common = hits.sum(0) > LINE_RUNS * np.isfinite(heights).sum(0)
    score = np.where(common, np.nanmedian(heights, axis=0), 0.0)
    for at in np.argsort(-score)[:50]:
        if score[at] <= 0:
            return None
        hit = speed[hits[:, at]]
        if hit.max() > LINE_SPEEDS * hit.min():
            return sharpened(eq, e, keys, float(grid[at]))
    return None


def _heights(t: Array, e: Array, grid: Array) -> Array:
    """Power at `grid` Hz over what is usual around it."""
    hz, height = over_usual(*on_even_grid(t, e)[:2])
    reach = max(1, round(0.02 / hz[1]))
    best = height.copy()
    for shift in range(1, reach + 1):
        best[shift:] = np.maximum(best[shift:], height[:-shift])
        best[:-shift] = np.maximum(best[:-shift], height[shift:])
    return np.asarray(np.interp(grid, hz, best))


def sharpened(eq: Equations, e: Mapping[Key, Array], keys: Sequence[Key], about: float) -> float:
    """The frequency that takes most from all runs together, each with its own phase."""
    best = about
    # 0.002 Hz first, then a tenth of a turn in the longest run
    for half in (0.06, 0.003):
        fine = best + np.linspace(-half, half, 61)
        total = np.zeros(fine.size)
        for key in keys:
            t = clock(eq, key)
            wave = np.exp(-2j * np.pi * np.multiply.outer(fine, t - t.mean()))
            total += np.abs(wave @ e[key]) ** 2 / e[key].size
        best = float(fine[int(np.argmax(total))])
    return best


def _line(eq: Equations, e: Mapping[Key, Array], columns: Mapping[Key, Array], frequency: float) -> Line:
    """Amplitudes and intervals at that frequency, of residuals that still have the wave."""
    keys = [key for key in e if key[1] == "L" and key in columns]
    sizes = [_size(e[key], columns[key]) for key in keys]
    amplitude = _amplitudes(eq, e, frequency) | ({"L": float(np.median(sizes))} if sizes else {})
    spread = float(np.std(sizes)) / np.sqrt(len(sizes)) if sizes else 0.0
    information = 0.0
    for key in keys or [k for k in e if k[1] == "A"]:
        t, n = clock(eq, key), e[key].size
        x = 2 * np.pi * frequency * t
        wave = _size(e[key], np.stack([np.cos(x), np.sin(x)], 1))
        noise = max(float(np.var(e[key])) - wave**2 / 2, 1e-300) * eq.noise.kappa[key[1]]
        information += wave**2 * n * (t[-1] - t[0]) ** 2 / (24 * noise)  # of 2π·f, one run      [rife1974]
    half_hz = float(np.hypot(Z95 / (2 * np.pi * np.sqrt(max(information, 1e-300))), CRYSTAL * frequency))
    if keys:
        speeds = np.array([eq.runs[run].turning for run, _ in keys])
        at_rest = _at_rest(speeds, np.array(sizes))
        return Line(frequency, amplitude, half_hz, Z95 * spread, float(np.median(sizes)), at_rest=at_rest)
    as_one, sizes = _as_one(eq, e, columns)
    spread = float(np.std(sizes)) / np.sqrt(len(sizes)) if sizes else 0.0
    return Line(frequency, amplitude, half_hz, Z95 * spread, float(np.median(sizes)) if sizes else 0.0, as_one)


def _at_rest(speeds: Array, sizes: Array) -> float:
    """The size where nothing turns, with its half width, over the mean: of the straight line through the sizes of runs
    (k,) at their speeds (k,); 1 of runs that are few, or turn alike."""
    if sizes.size < SEVERAL or speeds.max() < LINE_SPEEDS * speeds.min():
        return 1.0
    z = np.stack([np.ones(speeds.size), speeds], 1)
    x = np.linalg.lstsq(z, sizes, rcond=None)[0]
    variance = float(np.sum((sizes - z @ x) ** 2)) / (sizes.size - 2) * float(np.linalg.inv(z.T @ z)[0, 0])
    return float(x[0] + Z95 * np.sqrt(variance)) / max(float(sizes.mean()), 1e-300)


def _as_one(eq: Equations, e: Mapping[Key, Array], columns: Mapping[Key, Array]) -> tuple[float, list[float]]:
    """How much one torque in every run makes of what A and M show, each by itself: 1 where the torques they ask for are
    the same, 0 where one of them asks for none. And the size of the torque both together ask for in every run, N·m."""
    apart = asked = 0.0
    sizes: list[float] = []
    for run in sorted({i for i, c in columns if (i, c) in e}):
        keys = [(run, c) for c in "AM" if (run, c) in e and (run, c) in columns]
        if len(keys) < 2:
            continue
        made = [(eq.without_offset(key, columns[key]), eq.noise.weight(key[1])) for key in keys]
        grams = [w * z.T @ z for z, w in made]
        rights = [w * z.T @ e[key] for key, (z, w) in zip(keys, made, strict=True)]
        a, m = (np.linalg.pinv(g) @ r for g, r in zip(grams, rights, strict=True))
        apart += float((a - m) @ (a - m))
        asked += max(float(a @ a), float(m @ m))
        sizes.append(float(np.hypot(*(np.linalg.pinv(sum(grams)) @ sum(rights)))))
    return (1.0 - apart / asked if asked > 0 else 0.0), sizes


def _size(e: Array, columns: Array) -> float:
    """Amplitude of the wave that two columns make of a residual, beside an offset."""
    z = np.hstack([columns, np.ones((e.size, 1))])
    return float(np.hypot(*np.linalg.lstsq(z, e, rcond=None)[0][:2]))


def _amplitudes(eq: Equations, e: Mapping[Key, Array], frequency: float) -> dict[str, float]:
    """Median over runs, by channel, in its unit, with what the low-pass takes put back."""
    out = {}
    for channel in "AML":
        sizes = []
        for key in (k for k in e if k[1] == channel):
            t = clock(eq, key)
            sizes.append(2 * abs(np.exp(-2j * np.pi * frequency * t) @ e[key]) / e[key].size)
        if sizes:
            sigma = eq.runs[0].smoother.sigma_hz
            out[channel] = float(np.median(sizes)) * float(np.exp(0.5 * (frequency / sigma) ** 2))
    return out


def vibration_columns(eq: Equations, frequency: float) -> dict[Key, Array]:
    """Cosine and sine in every block in which a torque on the load shows, (n, 2)."""
    runs = sorted({i for i, _ in eq.rows})
    made = {i: eq.term(i, Term(VIBRATION, (frequency,))) for i in runs}
    return {(i, c): m for i in runs for c, m in made[i].items() if np.any(m)}
