"""Time is passed in. Nothing but a clock knows what time it is, or how to wait."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable

NEVER = -1e9  # s, before any time a clock tells: of what has not happened yet


def is_never(t: float) -> bool:
    """Whether `t` [s] stands for what has not happened yet."""
    return t <= NEVER


class Clock(ABC):
    """Monotonic time in seconds, and the only way to let it pass."""

    @abstractmethod
    def now(self) -> float:
        """Monotonic time [s]. The origin means nothing; differences do."""

    @abstractmethod
    def wait_until(self, t: float) -> float:
        """Return at time `t` [s] or, if that has passed, at once; gives the time it returned at [s]."""

    @abstractmethod
    def relax(self) -> bool:
        """Let other processes run without rig time passing. False where time cannot be held: nothing was waited for."""


class WallClock(Clock):
    """The machine's monotonic clock, with absolute deadlines. `on_wake` lets a simulated world catch up with it."""

    def __init__(self, on_wake: Callable[[float], None] | None = None) -> None:
        self._origin = time.monotonic()
        self._on_wake = on_wake

    def now(self) -> float:
        return time.monotonic() - self._origin

    def wait_until(self, t: float) -> float:
        remaining = self._origin + t - time.monotonic()
        if remaining > 0:
            time.sleep(remaining)
        now = time.monotonic() - self._origin
        if self._on_wake is not None:
            self._on_wake(now)
        return now

    def relax(self) -> bool:
        return False
