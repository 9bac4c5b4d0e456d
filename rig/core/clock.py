"""Time is passed in. Nothing but a clock knows what time it is, or how to wait."""

from __future__ import annotations

from abc import ABC, abstractmethod


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
        """Let other processes run without rig time passing. False where time cannot be held: then nothing was waited for."""
