"""What will happen, and when: modelled time in seconds, pulled along by whoever drives it."""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Callable

Act = Callable[[], None]


class Agenda:
    """Events in order of time; those of the same time in the order they were planned."""

    def __init__(self) -> None:
        self.now = 0.0  # s
        self._plans: list[tuple[float, int, Act]] = []
        self._order = itertools.count()

    def at(self, t: float, act: Act) -> None:
        """Plan `act` for `t` s, or for now when that has passed."""
        heapq.heappush(self._plans, (max(t, self.now), next(self._order), act))

    def after(self, delay: float, act: Act) -> None:
        """Plan `act` for `delay` s from now."""
        self.at(self.now + delay, act)

    @property
    def next(self) -> float:
        """When something happens next [s]; infinite when nothing does."""
        return self._plans[0][0] if self._plans else math.inf

    def run_until(self, t: float) -> None:
        """Let everything happen that is due by `t` s, each at its own time."""
        plans = self._plans
        while plans and plans[0][0] <= t:
            self.now, _, act = heapq.heappop(plans)
            act()
        self.now = max(self.now, t)


class Timer:
    """Fires `act` once, `start`'s delay after the latest start; cheap to start again with every frame."""

    def __init__(self, agenda: Agenda, act: Act) -> None:
        self._agenda, self._act = agenda, act
        self._due = math.inf  # s
        self._planned = math.inf  # s, the earliest wake-up on the agenda

    @property
    def running(self) -> bool:
        """Whether it will fire."""
        return self._due < math.inf

    def start(self, delay: float) -> None:
        """Fire in `delay` s instead of whenever it was going to."""
        self._due = self._agenda.now + delay
        if self._due < self._planned:
            self._plan()

    def stop(self) -> None:
        """Do not fire."""
        self._due = math.inf

    def _plan(self) -> None:
        self._planned = self._due
        self._agenda.at(self._due, self._wake)

    def _wake(self) -> None:
        if self._agenda.now < self._planned:
            return  # planned for later since; that wake-up will come
        self._planned = math.inf
        if self._agenda.now >= self._due:
            self._due = math.inf
            self._act()
        elif self.running:
            self._plan()
