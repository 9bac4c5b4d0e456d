"""How far apart the channels of a row say they were latched: mean and scatter in constant memory."""

from __future__ import annotations

import math


class LatchOffsets:
    """Of one channel against the motor angle, by the devices' own latch times. One `add` a tick, no allocation.

    It is what the drivers know; what they cannot know (a filter, a cable, a converter) only `hdrig run skew` sees.
    """

    def __init__(self) -> None:
        self.count = 0
        self._first = 0.0  # s; the sums are about it: offsets differ little, their squares would drown in its own
        self._sum = 0.0  # s
        self._squares = 0.0  # s²

    def add(self, offset: float) -> None:
        """One row whose channel was latched `offset` s after the motor angle, as told."""
        if not self.count:
            self._first = offset
        self.count += 1
        away = offset - self._first
        self._sum += away
        self._squares += away * away

    def summary(self) -> dict[str, float | int]:
        """What `timing.json` holds of it; times in s."""
        mean = self._sum / max(self.count, 1)
        spread = max(self._squares - mean * self._sum, 0.0)  # s², about the mean
        return {"mean": self._first + mean, "deviation": math.sqrt(spread / max(self.count - 1, 1)), "rows": self.count}
