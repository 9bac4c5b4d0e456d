"""How long frames waited to be taken, by the adapter's time stamps, whatever clock those count on."""

from __future__ import annotations

import math

WINDOW = 1.0  # s: in two of them an adapter's crystal drifts by 0.1 ms, a clock that is being set (500 ppm) by 1 ms
STEPPED = 0.1  # s more than before: the clock was set or is read coarsely; no machine that runs a loop waits so long


class Queueing:
    """The least difference between taking and stamping, over the last seconds, is no waiting; what is more, is.

    Two crystals differ by some 50 ppm, 3 ms a minute, and a clock may be set: a difference of clocks holds for seconds.
    """

    def __init__(self) -> None:
        self._least = self._before = math.inf  # s, of this window and of the one before
        self._since = -math.inf  # s, when this window began

    def waited(self, taken: float, stamp: float) -> float:
        """s that a frame stamped `stamp` had waited when it was `taken`, each on its own clock; 0 without a stamp."""
        if not stamp:
            return 0.0
        apart, age = taken - stamp, taken - self._since
        if age > WINDOW:
            self._before = self._least if age < 2 * WINDOW else math.inf
            self._least, self._since = math.inf, taken
        self._least = min(self._least, apart)
        waited = apart - min(self._least, self._before)
        if waited < STEPPED:
            return waited
        self._least = self._before = apart
        return 0.0
