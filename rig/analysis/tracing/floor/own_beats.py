"""A load angle that is read later and later, and at once soon again: two clocks that run apart, or a buffer that is
emptied at even times.

The delay comes round at one frequency in all runs, and what it makes of a turning angle is in proportion to the speed;
each run has its own phase, so that repeats differ by it and it is in the floor. An order of a shaft has no frequency of
its own, and a vibration no size that goes with the speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key, Term, less, orthonormal
from rig.analysis.tracing.floor.local import at_rows, clock
from rig.analysis.tracing.nameless.law import Nameless
from rig.core.quantiles import Z95
from rig.core.units import TURN
from rig.model.effect import Array, Parameter, Port, Shape, Signals, parameter
from rig.model.waves import wave

SEEN: Final = 0.2  # of the highest speed: below it a run tells little of its delay
RUNS: Final = 3  # that are fast enough
WIDE: Final = 1.5  # fastest over slowest of them
TURNS: Final = 2.5  # of the delay in the longest run, at least: fewer are a drift
HIGHEST: Final = 4.0  # Hz
STEP: Final = 0.2  # over the longest run, of the frequencies that are tried
PHASES: Final = 24
FINE: Final = 6.0  # times as near each other, the second time
FINER: Final = np.linspace(-1.0, 1.0, 13)  # steps about the best frequency, and about the best phase
APART: Final = 0.03  # s between rows, of those by which the frequency is found
LONGEST: Final = 40.0  # s of each run, the same
LEFT: Final = 0.5  # of a run's square, the most that a delay may leave
OF_ONE_WAVE: Final = 0.8  # the same of one wave: of what goes up evenly it leaves 0.39
MOSTLY: Final = 0.75  # of the runs that are fast enough
GROWS: Final = 0.3  # power of the speed by which a delay may grow or shrink


class BeatingDelay(Nameless):
    """The load angle is read δ too late, δ = δ_0 + δ_1·(t·f + φ mod 1) and two waves of that frequency."""

    name: ClassVar[str] = "beating_delay"
    in_short: ClassVar[str] = "a delay that comes round by the clock"
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("frequency", "phase")
    loose: ClassVar[tuple[bool, ...]] = (False, False)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Six, whose coefficients are delays [s]."""
        return {Port.READS_THETA_L: -np.nan_to_num(signals.omega_l)[:, None] * _delays(signals.t, *shape)}


@dataclass(frozen=True)
class OwnBeats:
    """Columns (n, k) of every run, how often the delay comes round [Hz], and how far it swings [s] in each run that
    tells, (runs,)."""

    columns: dict[Key, Array]
    frequency: float
    swings: Array

    def parameters(self) -> tuple[Parameter, ...]:
        """How far its values are from their mean, RMS: at an even speed the mean is a zero like any other."""
        half = Z95 * float(self.swings.std(ddof=1)) / np.sqrt(self.swings.size)
        return (parameter("scatter_theta_l", float(self.swings.mean()), half, "s"),)

    def sentence(self) -> str:
        """What it does, and what is not told."""
        return (
            f"The delay of one angle behind the other comes round every {1 / self.frequency:.3g} s in all runs, each "
            "with its own phase: what is left goes with the speed. Which of the two encoders is late nobody can tell."
        )


def own_beats(eq: Equations, e: Mapping[Key, Array], whole: Sequence[int], runs: Sequence[int]) -> OwnBeats | None:
    """In what is left `e` of runs `whole`, none of them a part of one; columns for all `runs`. None where no delay of
    one frequency leaves less than half of most runs that are fast enough."""
    free = {i: _run(eq, e, i) for i in whole if (i, "A") in e and not eq.runs[i].locked and "t" in eq.runs[i].has}
    fastest = max((run.speed for run in free.values()), default=0.0)
    told = {i: run for i, run in free.items() if run.speed > SEEN * fastest}
    if len(told) < RUNS or fastest < WIDE * min(run.speed for run in told.values()):
        return None
    frequency = _frequency(list(told.values()))
    if frequency is None:
        return None
    fits = {i: run.fitted(frequency) for i, run in told.items()}
    if np.mean([fit.left < LEFT for fit in fits.values()]) < MOSTLY or not _as_late(told, fits):
        return None
    columns: dict[Key, Array] = {}
    for i in (i for i in runs if (i, "A") in e):
        fit = fits.get(i) or _run(eq, e, i).fitted(frequency)
        made = eq.term(i, Term(BeatingDelay(), (frequency, fit.phase)))
        columns |= {(i, c): m for c, m in made.items() if np.any(m)}
    return OwnBeats(columns, frequency, np.array([fit.swing for fit in fits.values()]))


@dataclass(frozen=True)
class _Fit:
    """Phase at which least is left, share of the square that is left, and how far the delay swings, RMS [s]."""

    phase: float
    left: float
    swing: float


@dataclass(frozen=True)
class _Run:
    """Times [s], speed of the output [rad/s] and what is left of θ̃ [rad] of one run, (n,)."""

    t: Array
    omega: Array
    y: Array

    @property
    def speed(self) -> float:
        """RMS."""
        return float(np.sqrt(np.mean(self.omega**2)))

    def thinned(self) -> _Run:
        """Its first rows, some way apart."""
        by = max(1, int(APART / max(float(np.median(np.diff(self.t))), 1e-9)))
        rows = np.flatnonzero(self.t - self.t[0] < LONGEST)[::by]
        return _Run(self.t[rows], self.omega[rows], self.y[rows] - self.y[rows].mean())

    def waves(self, frequencies: Array) -> Array:
        """Share of the square that a delay of one wave leaves, of each frequency (k,)."""
        known = orthonormal(np.stack([np.ones(self.t.size), self.omega], 1))
        turns = TURN * self.t[:, None] * frequencies
        c, s = (less(known, self.omega[:, None] * of(turns)) for of in (np.cos, np.sin))
        y = less(known, self.y[:, None])
        cc, ss, cs, cy, sy = (np.sum(a * b, axis=0) for a, b in ((c, c), (s, s), (c, s), (c, y), (s, y)))
        taken = (ss * cy**2 - 2 * cs * cy * sy + cc * sy**2) / np.maximum(cc * ss - cs**2, 1e-300)
        return np.asarray((float(np.sum(y * y)) - taken) / max(float(self.y @ self.y), 1e-300))

    def fitted(self, frequency: float) -> _Fit:
        """Of the best phase."""
        phase = self._best(frequency, np.arange(PHASES) / PHASES)
        for width in (1 / PHASES, 1 / PHASES / FINE):
            phase = self._best(frequency, phase + FINER * width)
        left, c = self._at(frequency, phase)
        return _Fit(phase, left, float(np.std(_delays(self.t, frequency, phase) @ c[:-1])))

    def _best(self, frequency: float, phases: Array) -> float:
        """That of the `phases` (k,) at which least is left."""
        return float(phases[int(np.argmin([self._at(frequency, phase)[0] for phase in phases]))])

    def _at(self, frequency: float, phase: float) -> tuple[float, Array]:
        return self._left(self.omega[:, None] * _delays(self.t, frequency, phase))

    def _left(self, z: Array) -> tuple[float, Array]:
        """Share of the square that is left beside a zero, and coefficients, that of the zero last."""
        z = np.column_stack([z, np.ones(self.t.size)])
        c = np.linalg.lstsq(z, self.y, rcond=None)[0]
        return float(np.sum((self.y - z @ c) ** 2) / max(float(self.y @ self.y), 1e-300)), np.asarray(c, float)


def _run(eq: Equations, e: Mapping[Key, Array], run: int) -> _Run:
    key = (run, "A")
    return _Run(clock(eq, key), at_rows(eq, key, "omega_l"), e[key] - e[key].mean())


def _delays(t: Array, frequency: float, phase: float) -> Array:
    """What the delay is made of, (n, 6): itself, what goes up evenly and falls back, two waves."""
    turns = t * frequency + phase
    waves = [wave(TURN * k * turns) for k in (1, 2)]
    return np.column_stack([np.ones(t.size), np.mod(turns, 1.0) - 0.5, *waves])


def _frequency(seen: Sequence[_Run]) -> float | None:
    """At which delays of one wave leave least of all runs together, and then what falls back at once does; None where
    runs are too short, or one wave leaves nearly all of them."""
    few = [run.thinned() for run in seen]
    longest = max(float(np.ptp(run.t)) for run in few)
    step = STEP / longest
    grid = np.arange(TURNS / longest, HIGHEST, step)
    left = np.stack([run.waves(grid) for run in few], 1)
    if not grid.size or np.mean(left[at := int(np.argmin(left.mean(1)))] < OF_ONE_WAVE) < MOSTLY:
        return None
    best = float(grid[at])
    for width in (step, step / FINE):
        near = best + FINER * width
        best = float(near[int(np.argmin([np.mean([run.fitted(f).left for run in few]) for f in near]))])
    return best


def _as_late(told: Mapping[int, _Run], fits: Mapping[int, _Fit]) -> bool:
    """Whether the delay swings as far at any speed, so that what it makes of a run is in proportion to that."""
    speeds = np.log([run.speed for run in told.values()])
    swings = np.log([max(fit.swing, 1e-300) for fit in fits.values()])
    return bool(abs(np.polyfit(speeds, swings, 1)[0]) < GROWS)
