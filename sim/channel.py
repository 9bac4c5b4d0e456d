"""What the twin's channels share: counting, and the numbers a reading is made with."""

from __future__ import annotations

import math
from collections.abc import Callable
from math import floor

from rig.core.channels import Flag

SIMULATED = int(Flag.SIMULATED)  # plain integers: enum arithmetic costs as much as a reading
DRIVE_SATURATED = int(Flag.SIMULATED | Flag.SATURATED_DRIVE)
SENSOR_SATURATED = int(Flag.SIMULATED | Flag.SATURATED_TAU)
UNREAD = -math.inf  # s, a time no reading has
FINEST = 1e-9  # N·m, the resolution of a channel said to have none
new = tuple.__new__  # half the cost of a NamedTuple's own constructor, paid three times a tick


class Counter:
    """Counts since power-up. The lines lie at fixed angles of the shaft, the zero wherever it stood then."""

    __slots__ = ("first", "per_radian", "step")

    def __init__(self, counts_per_turn: int, theta: float) -> None:
        self.per_radian = counts_per_turn / (2.0 * math.pi)
        self.step = 2.0 * math.pi / counts_per_turn  # rad
        self.first = math.floor(theta * self.per_radian)

    @property
    def zero(self) -> float:
        """True angle [rad] at which count 0 begins: true angle = zero + counts·step + less than a step."""
        return self.first * self.step

    def count(self, theta: float) -> int:
        """Counts at the true angle `theta` rad."""
        return floor(theta * self.per_radian) - self.first

    def distorted(self, theta: float, value: Callable[[float], float]) -> float:
        """`theta` with its part since power-up seen through `value`."""
        return self.zero + value(theta - self.zero)
