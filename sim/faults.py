"""What can go wrong with a channel of the twin. Set `device.fault` while it runs; None heals it.

A drive has two more: `TwinDrive.trip(reason)`, its own fault, and `TwinDrive.deaf`, commands no longer arrive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeVar

Reading = TypeVar("Reading")


class Fault:
    """Something wrong with one channel: with the value it measures, or with the readings it hands over."""

    def value(self, x: float) -> float:
        """What is measured in place of `x` (rad since power-up, or N·m), before it is counted or clipped."""
        return x

    def reading(self, fresh: Reading, last: Reading) -> Reading:
        """What arrives when `fresh` was sent and `last` was the one before."""
        return fresh


class Silent(Fault):
    """Nothing new arrives: the last reading again, its time with it."""

    def reading(self, fresh: Reading, last: Reading) -> Reading:
        return last


class Frozen(Fault):
    """Time advances, the value does not."""

    def __init__(self) -> None:
        self._held: float | None = None

    def value(self, x: float) -> float:
        if self._held is None:
            self._held = x
        return self._held


@dataclass(frozen=True)
class Jump(Fault):
    """A slipped coupling, a shifted zero: `by` rad or N·m from now on."""

    by: float

    def value(self, x: float) -> float:
        return x + self.by


class MissedCounts(Fault):
    """Edges that came too close together: one count of `step` rad lost for every `every` rad travelled."""

    def __init__(self, step: float, every: float) -> None:
        self._step, self._every = step, every
        self._last: float | None = None
        self._travelled, self._behind = 0.0, 0.0  # rad

    def value(self, x: float) -> float:
        step = x - (x if self._last is None else self._last)
        self._last = x
        before = self._travelled // self._every
        self._travelled += abs(step)
        self._behind += math.copysign(self._step * (self._travelled // self._every - before), step)
        return x - self._behind


@dataclass(frozen=True)
class Scale(Fault):
    """A wrong ratio or counts per turn: `factor` times the value. −1 is a reversed channel."""

    factor: float

    def value(self, x: float) -> float:
        return self.factor * x


@dataclass(frozen=True)
class Overload(Fault):
    """A torque sensor driven to the end of its range, `sign` +1 or −1."""

    sign: int = 1

    def value(self, x: float) -> float:
        return math.copysign(math.inf, self.sign)
