"""Zeros of runs that go with the speed, whichever way: a bracket that is thrown outward, telemetry on a shaft.

Every run may have a zero of its own, so that no error shows it; but zeros that wander come back with no speed, and
those of unseen runs are foretold by a curve over the speed through the fitted ones'. What shifts them one way forth and
the other way back is a reading that comes late, and none of this.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import of_the_torque_sensor
from rig.analysis.tracing.residual.drifting_zeros import both_free
from rig.analysis.tracing.residual.levels import LEVELS, levels
from rig.analysis.tracing.residual.zeros_along import along
from rig.analysis.tracing.runs.recording import mean_speed
from rig.core.units import ARCSEC
from rig.model.effect import Array


@dataclass(frozen=True)
class ZerosBySpeed:
    """By how much the zeros of the angles differ between the slowest and the fastest runs [rad], what of the scatter of
    unseen zeros is foretold, and by how much the torque sensor's do [N·m] where it is they that go with the speed."""

    size: float
    foretold: float
    torque: float = 0.0

    def sentence(self) -> str:
        """What is said of it."""
        what = (
            f"The zero of the torque sensor goes with the speed, whichever way, by {abs(self.torque):.3g} N·m"
            if self.torque
            else f"The zeros of the angles go with the speed, whichever way, by {abs(self.size) / ARCSEC:.3g} arcsec"
        )
        return (
            f"{what} between the slowest and the fastest runs: a curve over the speed through those of the fitted runs "
            f"foretells {self.foretold:.0%} of how far apart those of unseen runs lie. Every run has a zero of its "
            "own, so that no error shows it, and no effect of the library explains it."
        )


def zeros_by_speed(s: Solution, fitted: Sequence[int], unseen: Sequence[int]) -> ZerosBySpeed | None:
    """None where θ̃'s zeros go with no speed, or as well with time or torque, or where the wind-up that shifts them
    was not measured."""
    eq = s.design.eq
    if (runs := both_free(eq, fitted, unseen)) is None:
        return None
    mine, others = runs
    if np.unique(levels(_speeds(eq, mine))).size < LEVELS:
        return None
    way = np.array([mean_speed(eq.runs[i]) for i in mine])
    torque = np.array([eq.runs[i].mean_torque for i in mine])
    instead = [np.stack([np.ones(x.size), x], 1) for x in (way, torque)]
    found = along(s, mine, others, lambda runs: _curve(_speeds(eq, runs)), instead)
    if found is None:
        return None
    sensed = found.size / s.value("compliance") if of_the_torque_sensor(s, (*mine, *others)) else 0.0
    return ZerosBySpeed(found.size, found.foretold, sensed)


def _speeds(eq: Equations, runs: Sequence[int]) -> Array:
    """Of the motor in each run, whichever way, rad/s."""
    return np.array([eq.runs[i].turning for i in runs])


def _curve(speed: Array) -> Array:
    """A constant and a parabola over the speed [rad/s] (n,), (n, 3)."""
    return np.stack([np.ones(speed.size), speed, speed**2], 1)
