"""The two kinds of clock a recorder can meet."""

from __future__ import annotations

import time

from rig.core.clock import Clock


class HeldClock(Clock):
    """Virtual: time passes only when somebody waits, so it can be held while the recorder catches up."""

    def __init__(self) -> None:
        self.held = 0

    def now(self) -> float:
        return 0.0

    def wait_until(self, t: float) -> float:
        return t

    def relax(self) -> bool:
        self.held += 1
        time.sleep(0.001)
        return True


class WallClock(HeldClock):
    """Time that cannot be held."""

    def relax(self) -> bool:
        return False
