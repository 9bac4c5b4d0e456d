"""Friction that is another one for a while, or from some moment on, in every run of that time: a brake that drags while
its coil is warm, a seal that begins to rub.

What repeats differ by is in the floor, so that no run stands out of it; but in the order they were taken the runs have
two levels, and as much of it whatever their speed.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import fdtrc

from rig.analysis.tracing.fit.channels import CHANNEL
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.residual.drifting_zeros import PLAINER, constants, falling, foretold
from rig.analysis.tracing.residual.joined import Index, Rest
from rig.analysis.tracing.residual.levels import Runs, left_by_runs
from rig.model.effect import Array

UNEVEN: Final = 0.3  # more rows one way than the other, over all: a slow run that ends on its way is as good
FEWEST: Final = 4  # runs within the while, and outside of it
BY_CHANCE: Final = 1e-6  # for all whiles that are tried together: a friction that wanders has longer memory than chance
LARGE: Final = 1.0  # of the floor
MOSTLY: Final = 0.85  # of what runs differ by beside a slope over the speed, either way
NUMBERS: Final = 3  # that a while has: when it begins and ends, and how much it is


@dataclass(frozen=True)
class ForAWhile:
    """By how much friction is more [N·m], in which channel, from the start of the first run to the end of the last one
    that has it [s], and what of the difference of runs that is."""

    channel: str
    size: float
    since: float
    until: float
    share: float

    def sentence(self) -> str:
        """What is said of it."""
        how = "more" if self.size > 0 else "less"
        return (
            f"Friction in {CHANNEL[self.channel].name} is {abs(self.size):.2g} N·m {how} in all runs between "
            f"{self.since:.0f} and {self.until:.0f} s of the campaign, whatever their speed: {self.share:.0%} of what "
            "runs differ by. Repeats differ by it, so that it is in the floor, and no effect of the library does so."
        )


def for_a_while(eq: Equations, rests: Mapping[str, Rest], floors: Mapping[Key, float]) -> ForAWhile | None:
    """Of what runs that turn leave, fitted or not, by channel; None where they have no such while."""
    found = [_in_channel(eq, channel, r, floors) for channel, r in rests.items()]
    return max((one for one in found if one is not None), key=lambda one: one.share, default=None)


def _in_channel(eq: Equations, channel: str, r: Rest, floors: Mapping[Key, float]) -> ForAWhile | None:
    if not eq.timed:
        return None
    runs = left_by_runs(r, UNEVEN)
    found = level_for_a_while(runs)
    if found is None:
        return None
    inside, size, share = found
    pieces = [piece for i in runs.number[inside] for piece in eq.runs[i].pieces]
    turned = np.unique(r.run)
    floor = float(np.median([floors[int(i), channel] for i in turned]))
    return ForAWhile(
        channel, size * floor, min(float(p.t[0]) for p in pieces), max(float(p.t[-1]) for p in pieces), share
    )


def what_a_baseline_takes(runs: Runs) -> Array:
    """Columns of what damping and a zero have taken on of friction that is another one by the run, (k, 4)."""
    return np.stack([np.ones(runs.left.size), runs.speed, runs.way, runs.speed * runs.way], 1)


def level_for_a_while(runs: Runs) -> tuple[Index, float, float] | None:
    """Which of the runs are in the while, by how much more they have, over the floor, and the share of what runs differ
    by; None where there is none, or what falls with time explains them as well."""
    order = np.argsort(runs.since)
    left, since, plain = runs.left[order], runs.since[order], what_a_baseline_takes(runs)[order]
    k = left.size

    def beside(x: Array) -> tuple[float, float]:
        """The coefficient of `x` (k,), and RMS of what is left."""
        z = np.column_stack([plain, x])
        _, fit, own = foretold(z, z, left)
        return float(fit[-1]), own

    cuts = [(a, b) for a, b in itertools.combinations(range(k + 1), 2) if FEWEST <= b - a <= k - FEWEST]
    free = k - plain.shape[1] - NUMBERS
    if not cuts or free < FEWEST:
        return None
    tried = [(beside(np.where((np.arange(k) >= a) & (np.arange(k) < b), 1.0, 0.0)), slice(a, b)) for a, b in cuts]
    (size, own), within = min(tried, key=lambda one: one[0][1])
    _, _, before = foretold(plain, plain, left)
    share = 1.0 - (own / max(before, 1e-300)) ** 2
    by_chance = len(cuts) * fdtrc(NUMBERS, free, share / max(1.0 - share, 1e-12) * free / NUMBERS)
    if by_chance > BY_CHANCE or share < MOSTLY or abs(size) < LARGE:
        return None
    falls = [beside(falling(since, tau)[:, 1])[1] for tau in constants(max(float(np.ptp(since)), 1.0))]
    return (order[within], size, share) if own < PLAINER * min(falls) else None
