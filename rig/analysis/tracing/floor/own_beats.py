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

from rig.analysis.tracing.fit.equations import Equations, Key, Term, orthonormal
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
GROWS: Final = (0.7, 1.3)  # power of the speed with which what it makes of a run grows


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
    free = [i for i in whole if (i, "A") in e and not eq.runs[i].locked and "t" in eq.runs[i].has]
    speed = {i: float(np.sqrt(np.mean(at_rows(eq, (i, "A"), "omega_l") ** 2))) for i in free}
    told = [i for i in free if speed[i] > SEEN * max(speed.values())]
    if len(told) < RUNS or max(speed[i] for i in told) < WIDE * min(speed[i] for i in told):
        return None
    seen = [_Run(clock(eq, (i, "A")), at_rows(eq, (i, "A"), "omega_l"), e[i, "A"] - e[i, "A"].mean()) for i in told]
    frequency = _frequency(seen)
    if frequency is None:
        return None
    fits = [run.fitted(frequency) for run in seen]
    left = np.array([fit.left for fit in fits])
    if np.mean(left < LEFT) < MOSTLY or not _grows(seen, fits):
        return None
    columns: dict[Key, Array] = {}
    for i in runs:
        phase = _Run(clock(eq, (i, "A")), at_rows(eq, (i, "A"), "omega_l"), e[i, "A"]).fitted(frequency).phase
        made = eq.term(i, Term(BeatingDelay(), (frequency, phase))) if (i, "A") in e else {}
        columns |= {(i, c): m for c, m in made.items() if np.any(m)}
    return OwnBeats(columns, frequency, np.array([fit.swing for fit in fits]))


@dataclass(frozen=True)
class _Fit:
    """Phase at which least is left, share of the square that is left, and how far the delay swings, RMS [s]; `made` is
    what that makes of θ̃, RMS [rad]."""

    phase: float
    left: float
    swing: float
    made: float


@dataclass(frozen=True)
class _Run:
    """Times [s], speed of the output [rad/s] and what is left of θ̃ [rad] of one run, (n,)."""

    t: Array
    omega: Array
    y: Array

    def thinned(self) -> _Run:
        """Its first rows, some way apart."""
        by = max(1, int(APART / max(float(np.median(np.diff(self.t))), 1e-9)))
        rows = np.flatnonzero(self.t - self.t[0] < LONGEST)[::by]
        return _Run(self.t[rows], self.omega[rows], self.y[rows] - self.y[rows].mean())

    def waves(self, frequencies: Array) -> Array:
        """Share of the square that a delay of one wave leaves, of each frequency (k,)."""
        known = orthonormal(np.stack([np.ones(self.t.size), self.omega], 1))
        turns = TURN * self.t[:, None] * frequencies
        c, s = (_without(known, self.omega[:, None] * of(turns)) for of in (np.cos, np.sin))
        y = _without(known, self.y[:, None])
        cc, ss, cs, cy, sy = (np.sum(a * b, axis=0) for a, b in ((c, c), (s, s), (c, s), (c, y), (s, y)))
        taken = (ss * cy**2 - 2 * cs * cy * sy + cc * sy**2) / np.maximum(cc * ss - cs**2, 1e-300)
        return np.asarray((float(np.sum(y * y)) - taken) / max(float(self.y @ self.y), 1e-300))

    def fitted(self, frequency: float) -> _Fit:
        """Of the best phase."""
        phase = self._best(frequency, np.arange(PHASES) / PHASES)
        for width in (1 / PHASES, 1 / PHASES / FINE):
            phase = self._best(frequency, phase + FINER * width)
        left, c = self._at(frequency, phase)
        delay = _delays(self.t, frequency, phase) @ c[:-1]
        swing = delay - delay.mean()
        made = float(np.sqrt(np.mean((self.omega * swing) ** 2)))
        return _Fit(phase, left, float(swing.std()), made)

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


def _without(known: Array, x: Array) -> Array:
    """What columns `known` (n, q), orthonormal, leave of others (n, k)."""
    return np.asarray(x - known @ (known.T @ x))


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


def _grows(seen: Sequence[_Run], fits: Sequence[_Fit]) -> bool:
    """Whether what the delay makes of a run grows in proportion to its speed."""
    speeds = np.log([float(np.sqrt(np.mean(run.omega**2))) for run in seen])
    power = float(np.polyfit(speeds, np.log([max(fit.made, 1e-300) for fit in fits]), 1)[0])
    least, most = GROWS
    return least < power < most
