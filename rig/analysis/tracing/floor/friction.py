"""Friction is never twice the same. A run that goes one way hides that in its mean, which may be its own; one that goes
both ways shows it, and few of those were repeated: how much it is, all pairs of repeats say together.

What all later repeats have less of is a drive that warms, and none of this.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.special import fdtri

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.local import at_rows
from rig.analysis.tracing.floor.offsets import ENOUGH, offset
from rig.analysis.tracing.floor.repeats import Scatter
from rig.analysis.tracing.runs.alike import ONE_WAY
from rig.analysis.tracing.runs.recording import Recording, mean_way
from rig.analysis.tracing.thresholds import CHANCE
from rig.model.effect import Array

LEAST_LEFT: Final = 0.05  # of the square of what a pair differs by: so much of it is no friction
DRIFTS: Final = ENOUGH + 1  # pairs, of which a common change can be taken off
OF_A_CHANNEL: Final = 0.98  # of campaigns: half a dozen runs, whose friction is known of half a dozen pairs


@dataclass(frozen=True)
class Friction:
    """Two repeats of one pair: by how much the later has more friction [N·m], and which share of the square of that is
    in their difference: all where they go as far forth as back, none where they go one way."""

    pair: tuple[int, int]
    gap: float
    shown: float


@dataclass(frozen=True)
class Scattering:
    """How far friction of one run lies from the others', squared [N²·m²], and of how many pairs that is known."""

    square: float = 0.0
    pairs: int = 0

    def words(self) -> str:
        """For the floor's account of itself; "" where nothing is known."""
        if not self.square:
            return ""
        return f"; friction differs by {1e3 * np.sqrt(self.square):.2g} mN·m RMS from run to run"

    def of(self, run: Recording) -> float:
        """Square of it [N²·m²] in what is left of a run: none where its mean is its own, or its friction."""
        if run.is_wound or abs(mean_way(run)) > ONE_WAY:
            return 0.0
        return (1.0 - mean_way(run) ** 2) * self.square

    def share(self, run: Recording, floor: float) -> float:
        """The same of the square of the `floor` of the motor torque [N·m]."""
        return min(self.of(run) / floor**2, 1.0)

    def of_one_run(self, share: float) -> float:
        """How much more than its floor a run may leave by chance, where so much of that is friction's."""
        return self._by_chance(share, 1.0, CHANCE) if share else 1.0

    def of_a_channel(self, shares: Array) -> float:
        """The same of runs together, whose rows each are a part of all: `shares` (n,) of the square of all."""
        whole = float(shares.sum())
        return self._by_chance(whole, whole**2 / float(shares @ shares), OF_A_CHANNEL) if whole else 1.0

    def _by_chance(self, share: float, free: float, chance: float) -> float:
        return float(np.sqrt(1.0 - share + share * fdtri(free, self.pairs, chance)))


def evened(s: Solution, found: Sequence[Scatter], variance: float) -> tuple[list[Scatter], Scattering]:
    """`found` of the motor torque, with what friction scatters by in the place of what two runs that go both ways
    happen to differ by in it. `variance` of a mean over one row, by noise alone.
    """
    seen = [f for one in found if (f := _friction(s, one)) is not None]
    if len(seen) < ENOUGH or not any(f.shown for f in seen):
        return list(found), Scattering()
    rows = {one.pair: one.rows for one in found}
    gaps, noise = np.array([f.gap for f in seen]), np.array([variance / rows[f.pair] for f in seen])
    drift, spent = (gaps.mean(), 1) if len(seen) >= DRIFTS else (0.0, 0)
    pairs = len(seen) - spent
    square = max(float(np.sum((gaps - drift) ** 2) / 2 / pairs - noise.mean()), 0.0)
    known = {f.pair: f for f in seen}
    made = [_with(one, known[one.pair], square) if one.pair in known else one for one in found]
    return made, Scattering(square, pairs)


def _with(one: Scatter, f: Friction, square: float) -> Scatter:
    own = max(one.rms**2 - f.shown * f.gap**2 / 2, LEAST_LEFT * one.rms**2)
    return replace(one, rms=float(np.sqrt(own + f.shown * square))) if f.shown else one


def _friction(s: Solution, one: Scatter) -> Friction | None:
    """Of two runs that turn freely, both one way or both both ways; None of others."""
    eq = s.design.eq
    early, late = sorted(one.pair, key=lambda i: eq.runs[i].start)
    if early == late or eq.runs[early].locked:
        return None
    means = [mean_way(eq.runs[i]) for i in (early, late)]
    if all(abs(mean) > ONE_WAY for mean in means):
        first, second = (offset(s, i, "M") * np.sign(mean) for i, mean in zip((early, late), means, strict=True))
        return Friction(one.pair, float(second - first), 0.0)
    if any(abs(mean) > ONE_WAY for mean in means):
        return None
    first, second = (_along(at_rows(eq, (i, "M"), "way"), s.residual((i, "M"))) for i in (early, late))
    return Friction(one.pair, second - first, 1.0 - float(np.mean(np.square(means))))


def _along(way: Array, e: Array) -> float:
    """How much of `e` (n,) goes with the way, beside a constant."""
    return float(np.linalg.lstsq(np.stack([np.ones(way.size), way], 1), e, rcond=None)[0][1])
