"""Zeros of runs that are one way forth and the other way back from some speed on: a counter that divides more coarsely
there and cuts off towards where it came from.

Every run may have a zero of its own, so that no error shows it. A reading that comes late shifts them with the way as
well, but in proportion to the speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import of_the_torque_sensor, zero
from rig.analysis.tracing.residual.drifting_zeros import LEFT, PLAINER, both_free, foretold, rivals
from rig.analysis.tracing.runs.recording import mean_speed
from rig.core.units import ARCSEC, RPM
from rig.model.effect import Array

EACH_WAY: Final = 2  # runs, above that speed and below: one is what any run may have


@dataclass(frozen=True)
class ZerosByWay:
    """By how much more the angles read forth than back in the runs that are faster than `above` [rad/s], rad, and what
    of the scatter of unseen zeros is foretold."""

    size: float
    above: float
    foretold: float

    def sentence(self) -> str:
        """What is said of it."""
        return (
            f"The zeros of the angles are {abs(self.size) / ARCSEC:.3g} arcsec apart forth and back in runs above "
            f"{self.above / RPM:.3g} rpm of the motor, the same at any higher speed, and alike below: that foretells "
            f"{self.foretold:.0%} of how far apart those of unseen runs lie. Every run has a zero of its own, so that "
            "no error shows it, and no effect of the library explains it."
        )


def zeros_by_way(s: Solution, fitted: Sequence[int], unseen: Sequence[int]) -> ZerosByWay | None:
    """None where θ̃'s zeros do not so, or as well what else shifts them, or where the wind-up was not measured."""
    eq = s.design.eq
    if (runs := both_free(eq, fitted, unseen)) is None:
        return None
    mine, others = runs
    zeros, wanted = (np.array([zero(s, i, "A") for i in runs]) for runs in (mine, others))
    speed, later = (np.array([mean_speed(eq.runs[i]) for i in runs]) for runs in (mine, others))
    tried = [(above, foretold(_step(speed, above), _step(later, above), zeros)) for above in _between(speed)]
    if not tried or of_the_torque_sensor(s, (*mine, *others)):
        return None
    above, (guess, fit, own) = min(tried, key=lambda one: one[1][2])
    spread, left = (float(np.sqrt(np.mean((wanted - x) ** 2))) for x in (zeros.mean(), guess))
    if left > LEFT * spread or own > PLAINER * min(rivals(eq, mine, zeros), default=np.inf):
        return None
    return ZerosByWay(2.0 * float(fit[2]), above, 1 - (left / spread) ** 2)


def _step(speed: Array, above: float) -> Array:
    """A constant, the speed, and its way where it is faster than `above`, (n, 3)."""
    return np.stack([np.ones(speed.size), speed, np.sign(speed) * (np.abs(speed) > above)], 1)


def _between(speed: Array) -> list[float]:
    """Speeds with EACH_WAY runs that are faster forth, as many back, and as many that are slower."""
    fast = np.unique(np.abs(speed))
    return [
        float(v)
        for v in (fast[1:] + fast[:-1]) / 2
        if min(np.sum(speed > v), np.sum(speed < -v), np.sum(np.abs(speed) < v)) >= EACH_WAY
    ]
