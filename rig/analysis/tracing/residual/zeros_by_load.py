"""Zeros of runs that go with what hung on the output: a cord that pulls the encoder's scale aside within its bearings.

In proportion to the weights that is a law of its own; what comes up against a stop, or gives way less and less, is
none. Its residual is not above the floor, as most of a run's zero is taken for its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import of_the_torque_sensor
from rig.analysis.tracing.residual.drifting_zeros import both_free
from rig.analysis.tracing.residual.zeros_along import along
from rig.analysis.tracing.runs.recording import mean_speed
from rig.core.units import ARCSEC
from rig.model.effect import Array

WEIGHTS: Final = 4  # different ones, none among them: of three a curve is through any zeros


@dataclass(frozen=True)
class ZerosByLoad:
    """By how much the zeros of the angles differ between the runs with the least and the most [rad], and what of the
    scatter of unseen zeros is foretold."""

    size: float
    foretold: float

    def sentence(self) -> str:
        """What is said of it."""
        return (
            f"The zeros of the angles go with what hangs on the output, by {abs(self.size) / ARCSEC:.3g} arcsec in "
            f"all: a curve over the weights through those of the fitted runs foretells {self.foretold:.0%} of how far "
            "apart those of unseen runs lie, and nothing winds up by it. Every run has a zero of its own, so that no "
            "error shows it, and no effect of the library explains it."
        )


def zeros_by_load(s: Solution, fitted: Sequence[int], unseen: Sequence[int]) -> ZerosByLoad | None:
    """None where θ̃'s zeros go with no weight, or as well with speed or time, or where the wind-up that shifts them was
    not measured."""
    eq = s.design.eq
    if (runs := both_free(eq, fitted, unseen)) is None:
        return None
    mine, others = runs
    if np.unique(_weights(eq, mine).round(1)).size < WEIGHTS or of_the_torque_sensor(s, (*mine, *others)):
        return None
    speed = np.array([mean_speed(eq.runs[i]) for i in mine])
    way_and_speed = np.stack([np.ones(speed.size), speed, np.abs(speed)], 1)
    found = along(s, mine, others, lambda runs: _curve(_weights(eq, runs)), [way_and_speed])
    return ZerosByLoad(found.size, found.foretold) if found else None


def _weights(eq: Equations, runs: Sequence[int]) -> Array:
    """What hung on the output in each run, N·m."""
    return np.array([float(np.nanmean(np.concatenate([p.tau_ext for p in eq.runs[i].pieces]))) for i in runs])


def _curve(weight: Array) -> Array:
    """A constant, the weight [N·m] (n,), and its root as it pulls, (n, 3)."""
    return np.stack([np.ones(weight.size), weight, np.sign(weight) * np.sqrt(np.abs(weight))], 1)
