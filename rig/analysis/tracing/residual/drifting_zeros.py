"""Zeros of runs that follow the campaign's time: a bracket that warms, an encoder whose electronics do.

Every run may have a zero of its own, so that such a drift is in no residual; but zeros that wander foretell nothing,
and zeros that drift are foretold by the time: those of unseen runs by a curve through the fitted ones'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import of_the_torque_sensor, zero
from rig.analysis.tracing.runs.recording import mean_speed
from rig.core.units import ARCSEC
from rig.model.effect import MEASURED, Array

FITTED: Final = 6  # runs that turn freely, at least
UNSEEN: Final = 4
LEFT: Final = 0.3  # of the scatter of the unseen zeros about their mean: zeros of one drift leave a twentieth
PLAINER: Final = 0.5  # of what any other thing leaves that may shift a zero: speeds may have been taken in turn
SHORTEST: Final = 0.03  # time constant, of the whole time
LONGEST: Final = 3.0  # beyond, it is a straight line
TRIED: Final = 24  # of them
SENSOR: Final = 2.5e-3  # of the largest torque: so much a sensor's zero may drift in half an hour
WAY: Final = 0.1  # of the scatter of all speeds, torques: less of it is no condition


@dataclass(frozen=True)
class DriftingZeros:
    """By how much the zeros of the runs differ in all [rad], the time constant [s], and what of the scatter of unseen
    zeros is foretold; by how much the torque sensor's do [N·m] where it is they that drift."""

    size: float
    time_constant: float
    foretold: float
    torque: float = 0.0

    def sentence(self) -> str:
        """What is said of it."""
        if self.torque:
            return (
                f"The zero of the torque sensor drifts through the campaign, by {self.torque:.3g} N·m in all with a "
                f"time constant near {self.time_constant:.2g} s. Every run has a zero of its own, so that no error "
                "shows it, and no effect of the library explains it."
            )
        return (
            f"The zeros of the angles drift through the campaign, by {abs(self.size) / ARCSEC:.3g} arcsec in all with "
            f"a time constant near {self.time_constant:.2g} s: a curve over the time through those of the fitted runs "
            f"foretells {self.foretold:.0%} of how far apart those of unseen runs lie. Every run has a zero of its "
            "own, so that no error shows it, and no effect of the library explains it."
        )


def drifting_zeros(s: Solution, fitted: Sequence[int], unseen: Sequence[int]) -> DriftingZeros | None:
    """The drift of θ̃'s zeros; None where they follow no time, or another thing as well, or where the wind-up that
    shifts them was not measured. The zero of every torque sensor drifts: that shifts θ̃ less its wind-up, and as much
    the balance of the load, is no drift of the angles, and told only where it is much."""
    eq = s.design.eq
    if (runs := both_free(eq, fitted, unseen)) is None:
        return None
    mine, others = runs
    seen = _drift(eq, mine, others, [np.array([zero(s, i, "A") for i in runs]) for runs in (mine, others)])
    if seen is None or not of_the_torque_sensor(s, (*mine, *others)):
        return seen
    torque = abs(seen.size) / s.value("compliance")
    return replace(seen, torque=torque) if torque > SENSOR * largest_torque(eq) else None


def largest_torque(eq: Equations) -> float:
    """Torque that a run has for a tenth of its time, N·m: peaks of a resonance are no measure, nor is what a lock test
    winds up, where any run turns freely."""
    read = [r for r in eq.runs if "tau_l" in r.has]
    turning = [r for r in read if not r.locked] or read
    return max(float(np.nanpercentile(np.abs(p.torque), 90)) for r in turning for p in r.pieces)


def _drift(eq: Equations, mine: Sequence[int], others: Sequence[int], found: Sequence[Array]) -> DriftingZeros | None:
    """Of the zeros `found` of the fitted runs and of the unseen ones."""
    zeros, wanted = found
    since, later = (times(eq, runs) for runs in (mine, others))
    span = float(np.ptp(np.concatenate([since, later])))
    spread = float(np.sqrt(np.mean((wanted - zeros.mean()) ** 2)))
    if span <= 0 or spread == 0:
        return None
    curves = [(tau, foretold(falling(since, tau), falling(later, tau), zeros)) for tau in constants(span)]
    tau, (guess, fit, own) = min(curves, key=lambda c: c[1][2])
    left = float(np.sqrt(np.mean((wanted - guess) ** 2)))
    rival = min(rivals(eq, mine, zeros), default=np.inf)
    if left > LEFT * spread or own > PLAINER * rival:
        return None
    size = float(fit[1]) * float(np.ptp(falling(np.concatenate([since, later]), tau)[:, 1]))
    return DriftingZeros(size, tau, 1 - (left / spread) ** 2)


def both_free(
    eq: Equations, fitted: Sequence[int], unseen: Sequence[int], read: frozenset[str] = MEASURED
) -> tuple[list[int], list[int]] | None:
    """Those of both that are `free`, or where none is unseen some of the fitted ones set `apart`; None where they are
    too few, or what is `read` in all was not in one."""
    mine, others = (free(eq, runs) for runs in (fitted, unseen))
    if not others:
        mine, others = apart(eq, mine)
    enough = len(mine) >= FITTED and len(others) >= UNSEEN
    return (mine, others) if enough and all(eq.runs[i].has >= read for i in (*mine, *others)) else None


def apart(eq: Equations, runs: Sequence[int]) -> tuple[list[int], list[int]]:
    """A part of those runs, and the others, evenly between them in time: where of every run a part was fitted, none of
    their zeros is unseen but to a curve that is not drawn through it."""
    in_turn = [runs[k] for k in np.argsort(times(eq, runs))]
    count = max(UNSEEN, len(runs) // 3)
    between = {in_turn[int(k)] for k in np.linspace(0, len(runs) - 1, count + 2).round()[1:-1]} if runs else set()
    return [i for i in runs if i not in between], [i for i in runs if i in between]


def free(eq: Equations, runs: Sequence[int]) -> list[int]:
    """Those in which the output turned and θ̃ was read."""
    return [i for i in runs if (i, "A") in eq.rows and not eq.runs[i].locked]


def times(eq: Equations, runs: Sequence[int]) -> Array:
    """When each was taken, s."""
    return np.array([np.mean([p.t[0] + p.t[-1] for p in eq.runs[i].pieces]) / 2 for i in runs])


def constants(span: float) -> Array:
    """Time constants to try, s."""
    return np.geomspace(SHORTEST * span, LONGEST * span, TRIED)


def falling(t: Array, tau: float) -> Array:
    """A constant and what falls with that time constant, (n, 2)."""
    return np.stack([np.ones(t.size), np.exp(-t / tau)], 1)


def foretold(z: Array, there: Array, zeros: Array) -> tuple[Array, Array, float]:
    """By columns `z` (n, k) of the fitted zeros what those of `there` (m, k) should be, the coefficients, and RMS of
    what is left."""
    x = np.asarray(np.linalg.lstsq(z, zeros, rcond=None)[0], dtype=np.float64)
    return there @ x, x, float(np.sqrt(np.mean((zeros - z @ x) ** 2)))


def rivals(eq: Equations, runs: Sequence[int], zeros: Array) -> list[float]:
    """RMS left of the zeros by their other reasons: speed and torque with their sizes, and a step at any time."""
    speed = np.array([mean_speed(eq.runs[i]) for i in runs])
    torque = np.array([eq.runs[i].mean_torque for i in runs])
    found = []
    for x in (speed, torque):
        if np.std(x) > WAY * np.mean(np.abs(x)):
            z = np.stack([np.ones(x.size), x, np.abs(x)], 1)
            found.append(foretold(z, z, zeros)[2])
    begun = np.argsort(times(eq, runs))
    for at in range(1, zeros.size):
        z = np.stack([np.ones(zeros.size), np.arange(zeros.size) >= at], 1)
        found.append(foretold(z, z, zeros[begun])[2])
    return found
