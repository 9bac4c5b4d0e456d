"""How far apart the channels of a row say they were latched: mean and scatter in constant memory."""

from __future__ import annotations

import math


class LatchOffsets:
    """Of one channel against the motor angle, by the devices' own latch times. One `add` a tick, no allocation.

    It is what the drivers know; what they cannot know (a filter, a cable, a converter) only `hdrig run skew` sees.
    """

    def __init__(self) -> None:
        self.count = 0
        self._mean = 0.0  # s
        self._squares = 0.0  # s², about the mean

    def add(self, offset: float) -> None:
        """One row whose channel was latched `offset` s after the motor angle, as told, by Welford's recurrence."""
        self.count += 1
        away = offset - self._mean
        self._mean += away / self.count
        self._squares += away * (offset - self._mean)

    def summary(self) -> dict[str, float | int]:
        """What `timing.json` holds of it; times in s."""
        deviation = math.sqrt(self._squares / (self.count - 1)) if self.count > 1 else 0.0
        return {"mean": self._mean, "deviation": deviation, "rows": self.count}
