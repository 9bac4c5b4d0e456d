"""Counts that were lost between two runs, while nobody recorded: every run from then on reads off by the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import of_the_torque_sensor, zero
from rig.analysis.tracing.runs.alike import alike
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter, parameter

FEWEST: Final = 3  # runs before the first step and after the last
INSIDE: Final = 2  # runs between two steps
STEPS: Final = 3  # of a campaign: of half an hour; with more of them a walk is steps too
CLEAR: Final = 7.0  # times the scatter of the zeros about their levels: of 18 that walk one set in 3000 has so much
PLAINER: Final = 0.5  # of what a drift with any time constant leaves of them
CONSTANTS: Final = np.geomspace(0.03, 3.0, 20)  # of the whole time: with a longer one a drift is a straight line
AS_EVER: Final = 3.0  # usual gaps between runs: in a longer one somebody may have homed the encoders anew


@dataclass(frozen=True)
class Between:
    """Runs in order of time, level by level; by how much the zero steps before every level but the first, rad (m − 1,),
    and the 95 % half width of each step."""

    levels: tuple[tuple[int, ...], ...]
    sizes: Array
    half_widths: Array

    @property
    def runs(self) -> tuple[int, ...]:
        """Those after the first step."""
        return tuple(i for level in self.levels[1:] for i in level)

    def columns(self, eq: Equations) -> dict[Key, Array]:
        """Of each of those runs, a zero of its own in A, (n, 1); told apart, level from level, by what stands there."""
        of = [(i, number) for number, level in enumerate(self.levels) if number for i in level]
        return {(i, "A"): np.full((eq.rows[i, "A"].y.size, 1), float(number)) for i, number in of}

    def parameters(self) -> tuple[Parameter, ...]:
        """The largest step, of the load encoder: which of the two it was the zero does not tell."""
        most = int(np.argmax(np.abs(self.sizes)))
        size = parameter("step_theta_l", float(abs(self.sizes[most])), float(self.half_widths[most]), "rad")
        return parameter("steps", float(self.sizes.size), 0.0, "1"), size

    def sentence(self, eq: Equations) -> str:
        """Where they lie."""
        often = ("once", "twice", "three times")[self.sizes.size - 1]
        at = [
            f"between the runs {eq.runs[before[-1]].name} and {eq.runs[after[0]].name}"
            for before, after in pairwise(self.levels)
        ]
        where = at[0] if len(at) == 1 else f"{', '.join(at[:-1])} and {at[-1]}"
        return (
            f"The zeros of the encoders step {often}, {where}, while nobody recorded: counts were lost, or an encoder "
            "was homed anew. Which of the two encoders it was they do not tell."
        )


def find_between(s: Solution, whole: Sequence[int]) -> Between | None:
    """Of the runs `whole`, none of them a part of one; None unless as few steps as can be explain all their zeros, no
    zero comes back to where it was, and every level has a condition in common with another."""
    eq = s.design.eq
    runs = sorted((i for i in whole if (i, "A") in eq.rows and not eq.runs[i].locked), key=lambda i: eq.runs[i].start)
    if len(runs) < 2 * FEWEST:
        return None
    zeros = np.array([zero(s, i, "A") for i in runs])
    most = PLAINER * _beside_a_drift(np.array([eq.runs[i].start for i in runs]), zeros)
    for steps in range(1, STEPS + 1):
        ends = _best(zeros, steps)
        if ends is None or (scatter := _scatter(zeros, ends)) > most:
            continue
        means = np.array([zeros[a:b].mean() for a, b in pairwise(ends)])
        apart = np.abs(means[:, None] - means)[np.triu_indices(means.size, 1)]
        if apart.min() >= CLEAR * scatter:
            return None if of_the_torque_sensor(s, runs) else _vouched(eq, runs, ends, np.diff(means), scatter)
    return None


def _vouched(eq: Equations, runs: Sequence[int], ends: Sequence[int], sizes: Array, scatter: float) -> Between | None:
    """Unless somebody may have homed an encoder, or a condition may shift the zero."""
    levels = tuple(tuple(runs[a:b]) for a, b in pairwise(ends))
    if not all(_gap_as_ever(eq, runs, at) for at in ends[1:-1]) or not _tied(eq, levels):
        return None
    counts = np.diff(ends)
    return Between(levels, sizes, Z95 * scatter * np.sqrt(1 / counts[:-1] + 1 / counts[1:]))


def _best(zeros: Array, steps: int) -> tuple[int, ...] | None:
    """Where the levels of zeros (n,) begin, and n: those that leave least about their means, found level by level (of
    all ways to cut at a row the best is one of the best ways to cut before it)."""
    n, apart = zeros.size, zeros - zeros.mean()
    total, squares = (np.concatenate([[0.0], np.cumsum(x)]) for x in (apart, apart**2))
    cut: dict[int, tuple[float, tuple[int, ...]]] = {
        b: (squares[b] - total[b] ** 2 / b, (0, b)) for b in range(FEWEST, n)
    }
    for level in range(1, steps + 1):
        shortest, ends = (FEWEST, [n]) if level == steps else (INSIDE, range(FEWEST, n))
        cut = {
            b: min(
                (left + squares[b] - squares[a] - (total[b] - total[a]) ** 2 / (b - a), (*at, b))
                for a, (left, at) in cut.items()
                if b - a >= shortest
            )
            for b in ends
            if any(b - a >= shortest for a in cut)
        }
    return cut[n][1] if n in cut else None


def _left(zeros: Array, ends: Sequence[int]) -> float:
    """Squares of zeros (n,) about the mean of their level."""
    return float(sum(np.sum((zeros[a:b] - zeros[a:b].mean()) ** 2) for a, b in pairwise(ends)))


def _scatter(zeros: Array, ends: Sequence[int]) -> float:
    """Of zeros (n,) about the means of their levels; each step takes its size and its place."""
    return float(np.sqrt(_left(zeros, ends) / max(zeros.size - 2 * (len(ends) - 2), 1)))


def _beside_a_drift(times: Array, zeros: Array) -> float:
    """RMS of what the best drift leaves of zeros (n,) at those times (n,) [s]."""
    share = (times - times[0]) / max(float(np.ptp(times)), 1e-9)
    left = []
    for constant in CONSTANTS:
        z = np.stack([np.ones(share.size), np.exp(-share / constant)], 1)
        e = zeros - z @ np.linalg.lstsq(z, zeros, rcond=None)[0]
        left.append(float(np.sqrt(e @ e / (zeros.size - 2))))
    return min(left)


def _gap_as_ever(eq: Equations, runs: Sequence[int], at: int) -> bool:
    """Whether there was no longer break before the run `at` than between others."""
    begun = np.array([eq.runs[i].start for i in runs])
    ended = np.array([eq.runs[i].pieces[-1].t[-1] for i in runs])
    gaps = begun[1:] - ended[:-1]
    return bool(gaps[at - 1] <= AS_EVER * max(float(np.median(gaps)), 1.0))


def _tied(eq: Equations, levels: Sequence[Sequence[int]]) -> bool:
    """Whether the levels hang together by conditions that were taken on several: else it may be the condition that
    shifts the zero."""
    tied = {0}
    for _ in levels:
        tied |= {
            b
            for b in range(len(levels))
            for a in tied
            if any(alike(eq.runs[i], eq.runs[j]) for i in levels[a] for j in levels[b])
        }
    return len(tied) == len(levels)
