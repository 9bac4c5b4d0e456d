"""A spring that is not the same twice in runs that turn freely: repeats that differ along their torque.

What makes repeats differ is their floor and never above it. Where that is mostly one number a run, the wind-up for a
newton metre, and the later of two repeats has always more of it, or always less, the spring has changed between them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.local import at_rows
from rig.analysis.tracing.floor.repeats import scatter
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.runs.holdout import HELD_PART
from rig.model.effect import Array

PAIRS: Final = 4  # of repeats
MOSTLY: Final = 0.3  # of the square of what repeats differ by; on clean campaigns it is a hundredth
ONE_WAY: Final = 0.9  # of that: the later ones give more, or less


@dataclass(frozen=True)
class OtherSpring:
    """By how much the wind-up for a N·m is more in the later of repeats, over the stiffness' own [1], and how much of
    the square of what repeats differ by that is."""

    softer: float
    share: float

    def sentence(self) -> str:
        """What is said of it."""
        return (
            f"The stiffness is not the same twice: in the later of two runs taken alike the gear winds up "
            f"{abs(self.softer):.1%} {'more' if self.softer > 0 else 'less'} for the same torque, {self.share:.0%} of "
            "the square of what repeats differ by in kinematic error; it is in the floor, and no effect of the library "
            "explains it."
        )


def same_spring(eq: Equations, e: Mapping[Key, Array], compliance: float) -> OtherSpring | None:
    """What the repeats in the residuals `e` (n,) of all runs say, beside a `compliance` [rad/(N·m)]; None where they
    are few or differ by something else."""
    runs = [i for i, c in e if c == "A" and not eq.runs[i].locked and "tau_l" in eq.runs[i].has]
    whole = [i for i in runs if HELD_PART not in eq.runs[i].name]
    pairs = [(a, b) if eq.runs[a].start < eq.runs[b].start else (b, a) for a, b in repeats(eq.runs, whole)]
    if len(pairs) < PAIRS:
        return None
    slopes = {i: _slope(eq, e, i) for pair in pairs for i in pair}
    own = {(i, "A"): e[i, "A"] - slope * _torque(eq, i) for i, slope in slopes.items()}
    both = [(scatter(eq, e, pair, "A"), scatter(eq, own, pair, "A")) for pair in pairs]
    known = [(pair, x, y) for pair, (x, y) in zip(pairs, both, strict=True) if x is not None and y is not None]
    gone = np.array([x.rows * (x.rms**2 - y.rms**2) for _, x, y in known])
    total = sum(x.rows * x.rms**2 for _, x, _ in known)
    more = np.array([slopes[b] - slopes[a] for (a, b), _, _ in known])
    share = float(gone.sum()) / max(total, 1e-300)
    softer = float(gone @ more) / max(float(np.sum(gone)), 1e-300) / compliance if known and compliance > 0 else 0.0
    one_way = float(gone[more * softer > 0].sum())
    if len(known) < PAIRS or share < MOSTLY or one_way < ONE_WAY * float(np.abs(gone).sum()):
        return None
    return OtherSpring(softer, share)


def _torque(eq: Equations, run: int) -> Array:
    """About its mean, at each row of A, N·m."""
    torque = at_rows(eq, (run, "A"), "torque")
    return np.asarray(torque - torque.mean())


def _slope(eq: Equations, e: Mapping[Key, Array], run: int) -> float:
    """Of the residual over the torque in a run, rad/(N·m)."""
    torque = _torque(eq, run)
    return float(torque @ e[run, "A"]) / max(float(torque @ torque), 1e-300)
