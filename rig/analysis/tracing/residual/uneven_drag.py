"""A drag of the motor, or of the load, that is more one way, the more the faster: every run has a zero of its own in
each balance of torques, which takes it on, so that no error shows it, or little of it.

A run that turns one way at one speed cannot tell it from a zero. All of them together can: their zeros lie on one curve
over the size of the speed, the same forth and back, and those of unseen runs on the curve through the fitted ones'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import by_the_torque_sensor, zero
from rig.analysis.tracing.residual.drifting_zeros import foretold
from rig.analysis.tracing.runs.recording import mean_speed
from rig.core.quantiles import Z95
from rig.core.units import RPM
from rig.model.effect import Array

FITTED: Final = 8  # runs that turn one way: a curve beside what friction has wrong takes four numbers
UNSEEN: Final = 4
EACH_WAY: Final = 2  # of the fitted ones that turn at least HALF as fast as the fastest
HALF: Final = 0.4
ONE_WAY: Final = 0.9  # of the way
POWERS: Final = (0.5, 1.0, 2.0)  # of a film between lip and shaft, of a fluid, of what it stirs
LEFT: Final = 0.4  # of what friction leaves of the unseen zeros, or a drift does
PLAIN: Final = 3.0  # half widths of its interval, six standard errors
LARGE: Final = 2.0  # floors of that torque: less matters to nobody
WHAT: Final = {"M": ("motor", 1e3, "mN·m"), "L": ("load", 1.0, "N·m")}  # what a channel balances, and in which unit


@dataclass(frozen=True)
class UnevenDrag:
    """By how much the drag is more forward than backward at the fastest speed [N·m], its 95 % half width, that speed
    [rad/s], and what of the unseen zeros is foretold."""

    size: float
    half: float
    speed: float
    foretold: float
    channel: str = "M"

    def sentence(self) -> str:
        """What is said of it."""
        way = "forward" if self.size > 0 else "backward"
        what, times, unit = WHAT[self.channel]
        return (
            f"The {what} is dragged by {times * abs(self.size):.3g} ± {times * self.half:.2g} {unit} more {way} than "
            f"the other way at {self.speed / RPM:.0f} rpm of the motor, and by less the slower it turns; it foretells "
            f"{self.foretold:.0%} of what the zeros of the {what}'s torque in unseen runs differ by. Every run has "
            "such a zero of its own, so that no error shows all of it, and no effect of the library explains it."
        )


def uneven_drag(
    s: Solution, fitted: Sequence[int], unseen: Sequence[int], floor: float, channel: str = "M"
) -> UnevenDrag | None:
    """Of the zeros of the motor's torque, or of the load's balance (`channel` M or L); None where they lie on no curve
    over the speed, or on one that is less than the `floor` [N·m], or where hardly any run turns fast the other way, or
    where it is the torque sensor's own zero, which winds nothing up."""
    eq = s.design.eq
    mine, others = (_one_way(eq, runs, channel) for runs in (fitted, unseen))
    speed, later = (np.array([mean_speed(eq.runs[i]) for i in runs]) for runs in (mine, others))
    if speed.size < FITTED or later.size < UNSEEN:
        return None
    fast = np.abs(speed) > HALF * np.abs(speed).max()
    if min(np.sum(fast & (speed > 0)), np.sum(fast & (speed < 0))) < EACH_WAY:
        return None
    begun, after = (np.array([eq.runs[i].start for i in runs]) for runs in (mine, others))
    zeros, wanted = (np.array([zero(s, i, channel) for i in runs]) for runs in (mine, others))
    plain, there = _friction(speed), _friction(later)
    fastest = np.abs(speed).max()
    before = _left(plain, there, zeros, wanted)
    drifts = _left(np.column_stack([begun, plain]), np.column_stack([after, there]), zeros, wanted)
    curves = [((np.abs(speed) / fastest) ** p, (np.abs(later) / fastest) ** p) for p in POWERS]
    tried = [(np.column_stack([x, plain]), np.column_stack([y, there])) for x, y in curves]
    left, best = min((_left(*z, zeros, wanted), i) for i, z in enumerate(tried))
    size, half = _size(tried[best][0], zeros)
    if left > LEFT * min(before, drifts) or abs(size) < max(LARGE * floor / 2, PLAIN * half):
        return None
    if channel == "L" and by_the_torque_sensor(s, (*mine, *others)):
        return None
    return UnevenDrag(2 * size, 2 * half, float(fastest), 1 - (left / before) ** 2, channel)


def _one_way(eq: Equations, runs: Sequence[int], channel: str) -> list[int]:
    """Those in which the motor turned freely, one way."""
    free = [i for i in runs if (i, channel) in eq.rows and not eq.runs[i].locked]
    return [i for i in free if abs(mean_speed(eq.runs[i])) > ONE_WAY * eq.runs[i].turning]


def _friction(speed: Array) -> Array:
    """What a zero may have besides: one for all, and what is wrong in a constant friction and in one that grows with
    the speed, (n, 3)."""
    return np.stack([np.ones(speed.size), np.sign(speed), speed], 1)


def _left(z: Array, there: Array, zeros: Array, wanted: Array) -> float:
    """RMS that columns `z` (n, k) through the fitted zeros leave of the unseen ones, whose columns are `there`."""
    return float(np.sqrt(np.mean((wanted - foretold(z, there, zeros)[0]) ** 2)))


def _size(z: Array, zeros: Array) -> tuple[float, float]:
    """The first coefficient, and half its 95 % interval by what is left."""
    x = np.linalg.lstsq(z, zeros, rcond=None)[0]
    variance = float(np.sum((zeros - z @ x) ** 2)) / max(zeros.size - z.shape[1], 1)
    return float(x[0]), Z95 * float(np.sqrt(variance * np.linalg.pinv(z.T @ z)[0, 0]))
