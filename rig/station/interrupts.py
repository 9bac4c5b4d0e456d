"""Interrupts of a session that a page watches: signals, the page's switches, and the page's own absence."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import final

from rig.live.switches import Counts, Switches
from rig.process.interrupts import Interrupts


@final
class Panel(Interrupts):
    """`count` and `held` look at the switches each time: the loop does so every tick, and nothing stands in between.

    What counts is what was pressed after the act that is being carried out was accepted: `arm` says how often each had
    been pressed by then. Two stops are one stop, not a halt.
    """

    def __init__(self, switches: Switches) -> None:
        self._switches = switches
        self._taken = switches.pressed
        self._total = -1  # presses seen so far, all switches together; -1: not looked yet
        self._asked = 0  # by the switches: 1 stop, 2 halt
        self._hold = False
        self._patience = float("inf")  # s without a page, then stop
        self.lost = False  # the page was, and a stop followed from it
        self.alone = False  # the page's server is gone, and a stop followed from it
        super().__init__()

    def arm(self, taken: Counts, page_lost_s: float = float("inf")) -> None:
        """A new act: presses before `taken` are over and done; `page_lost_s` without a page are a stop."""
        self._taken, self._patience, self.lost = taken, page_lost_s, False
        self._total = -1
        self.held = self._stop_key = False

    def disarm(self) -> None:
        """Nothing is being carried out: a page may come and go."""
        self._patience = float("inf")

    @contextlib.contextmanager
    def unwatched(self) -> Iterator[None]:
        """While somebody has to do something by hand nothing moves: his page may sleep meanwhile."""
        patience, self._patience = self._patience, float("inf")
        try:
            yield
        finally:
            self._patience = patience

    def left_alone(self) -> None:
        """The page's server is gone, for good: a motor that is held, which only a switch would end, is stopped."""
        self.alone = self.alone or self.held

    def _look(self) -> None:
        """At the switches, when any was pressed since the last look: nearly every tick that is one comparison."""
        if self._switches.total == self._total:
            return
        pressed = self._switches.pressed
        self._total = sum(pressed)
        self._asked = 2 if pressed.halt != self._taken.halt else int(pressed.stop != self._taken.stop)
        self._hold = pressed.hold != self._taken.hold
        self._switches.tell_seen(pressed)

    @property
    def count(self) -> int:
        """1 stop, 2 halt."""
        self._look()
        if not (self._asked or self._heard or self._keyed or self.lost):
            self.lost = self._switches.page_age > self._patience
        return max(self._asked, len(self._heard), self._keyed, int(self.lost or self.alone))

    @count.setter
    def count(self, value: int) -> None:
        self._heard = [0] * value

    @property
    def held(self) -> bool:
        """Somebody asked for a hold."""
        self._look()
        return self._hold or self._held

    @held.setter
    def held(self, value: bool) -> None:
        self._held = value

    @property
    def signalled(self) -> bool:
        """True once a signal told this process to end."""
        return bool(self._heard)

    @property
    def who(self) -> str:
        """Who asked, for sentences that say that something was ended."""
        if self.alone and self.count == 1:
            return "because the page's server is gone and nobody else could let go of a motor that is held"
        if self.lost and self.count == 1:
            return f"because no page had been seen for {self._patience:g} s, as [console] page_lost says"
        return super().who
