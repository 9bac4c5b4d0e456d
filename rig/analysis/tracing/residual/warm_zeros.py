"""Zeros of runs that follow a temperature that was read: a bracket that grows, a head on an arm of another metal.

Every run may have a zero of its own, so that no error shows it; but zeros that wander follow no thermometer, and those
of unseen runs are foretold by a line through the fitted ones'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import zero
from rig.analysis.tracing.residual.drifting_zeros import (
    PLAINER,
    SENSOR,
    both_free,
    constants,
    falling,
    foretold,
    largest_torque,
    rivals,
    times,
)
from rig.core.units import ARCSEC
from rig.model.effect import MEASURED, Array

LEFT: Final = 0.5  # of the scatter of the unseen zeros about their mean, beside one line with what was read
UNREAD: Final = 0.3  # the same where nobody read the torque: what bearings take of it winds up by the temperature too
READ: Final = frozenset({"t", "theta_m", "theta_l"})
WARMER: Final = 0.5  # K between the coldest and the warmest run, at least


@dataclass(frozen=True)
class WarmZeros:
    """By how much a kelvin shifts the zeros of the angles [rad/K], over how many kelvin [K], and what of the scatter of
    unseen zeros is foretold; by how much it shifts the torque sensor's [N·m/K] where it is they that follow."""

    slope: float
    span: float
    foretold: float
    torque: float = 0.0

    @property
    def size(self) -> float:
        """Between the coldest and the warmest run, rad."""
        return self.slope * self.span

    def sentence(self) -> str:
        """What is said of it."""
        if self.torque:
            return (
                f"The zero of the torque sensor follows the temperature, by {self.torque:.3g} N·m a kelvin over "
                f"{self.span:.1f} K: a line through the zeros of the fitted runs foretells {self.foretold:.0%} of how "
                "far apart those of unseen runs lie. Every run has a zero of its own, so that no error shows it, and "
                "no effect of the library explains it."
            )
        return (
            f"The zeros of the angles follow the temperature, by {self.slope / ARCSEC:.3g} arcsec a kelvin over "
            f"{self.span:.1f} K: a line through those of the fitted runs foretells {self.foretold:.0%} of how far "
            "apart those of unseen runs lie. Every run has a zero of its own, so that no error shows it, and no effect "
            "of the library explains it."
        )


def warm_zeros(s: Solution, fitted: Sequence[int], unseen: Sequence[int]) -> WarmZeros | None:
    """None where nobody read a temperature, or θ̃'s zeros follow it no better than the time, a speed or a torque. The
    zero of the torque sensor, which may follow it as well, is taken off where it is known, and told itself where it
    alone does, by much.
    """
    eq = s.design.eq
    if (runs := both_free(eq, fitted, unseen, READ)) is None:
        return None
    mine, others = runs
    if not float(np.ptp(_warmth(eq, (*mine, *others)))) > WARMER:  # NaN where it was not read
        return None
    if (angles := _following(eq, mine, others, [[_zero(s, i) for i in runs] for runs in (mine, others)])) is not None:
        return angles
    if any((i, "L") not in eq.rows for i in (*mine, *others)):
        return None
    bare = _following(eq, mine, others, [[zero(s, i, "A") for i in runs] for runs in (mine, others)])
    torque = -bare.slope / s.value("compliance") if bare else 0.0
    return replace(bare, torque=torque) if bare and abs(torque) * bare.span > SENSOR * largest_torque(eq) else None


def _following(
    eq: Equations, mine: Sequence[int], others: Sequence[int], found: Sequence[Sequence[float]]
) -> WarmZeros | None:
    """Of the zeros `found` of the fitted runs and of the unseen ones."""
    zeros, wanted = (np.array(x) for x in found)
    warm, warm_later = (_warmth(eq, runs) for runs in (mine, others))
    guess, x, own = foretold(_line(warm), _line(warm_later), zeros)
    spread = float(np.sqrt(np.mean((wanted - zeros.mean()) ** 2)))
    left = float(np.sqrt(np.mean((wanted - guess) ** 2)))
    read = all(eq.runs[i].has >= MEASURED for i in (*mine, *others))
    if left > (LEFT if read else UNREAD) * spread or own > PLAINER * min(rivals(eq, mine, zeros), default=np.inf):
        return None
    if own > min(_by_time(eq, mine, zeros)):
        return None
    span = float(np.ptp(np.concatenate([warm, warm_later])))
    return WarmZeros(float(x[1]), span, 1 - (left / spread) ** 2)


def _zero(s: Solution, run: int) -> float:
    """Of the angles of a run, rad."""
    of_the_torque = zero(s, run, "L") if (run, "L") in s.design.eq.rows else 0.0
    return zero(s, run, "A") + s.value("compliance") * of_the_torque


def _warmth(eq: Equations, runs: Sequence[int]) -> Array:
    """Mean temperature of each run, °C, NaN where it was not read."""
    return np.array([np.mean(np.concatenate([p.temperature for p in eq.runs[i].pieces])) for i in runs])


def _line(x: Array) -> Array:
    return np.stack([np.ones(x.size), x], 1)


def _by_time(eq: Equations, runs: Sequence[int], zeros: Array) -> list[float]:
    """RMS left of the zeros by drifts of all time constants."""
    t = times(eq, runs)
    drifts = (falling(t, constant) for constant in constants(float(np.ptp(t))))
    return [foretold(z, z, zeros)[2] for z in drifts]
