"""The one loop of the twin's process: lets modelled time follow the wall clock, and serves sockets and ptys between."""

from __future__ import annotations

import ctypes
import select
import time
from abc import ABC, abstractmethod

from sim.wire.agenda import Agenda

LONGEST = 0.002  # s of sleep: the plant keeps up in small steps, and a stop is noticed
PR_SET_TIMERSLACK = 29  # prctl: the kernel may otherwise wake us 50 µs late


class Source(ABC):
    """Something with a file descriptor."""

    @abstractmethod
    def fileno(self) -> int:
        """What to wait for."""

    @abstractmethod
    def ready(self) -> None:
        """There is something to read."""

    @abstractmethod
    def close(self) -> None:
        """The end."""

    def wants(self) -> bool:
        """Whether it can take more now."""
        return True


class Reactor:
    """Runs until `stop`. `late` is the longest that an event waited for the processor [s], until somebody resets it."""

    def __init__(self, agenda: Agenda) -> None:
        self.agenda = agenda
        self.origin = time.monotonic() - agenda.now  # wall clock at modelled time 0
        self.late = 0.0
        self.stopped = False
        self._sources: list[Source] = []

    def add(self, source: Source) -> None:
        """Serve it from now on."""
        self._sources.append(source)

    def remove(self, source: Source) -> None:
        """No longer."""
        self._sources.remove(source)

    def stamp(self, t: float) -> int:
        """Modelled time [s] as ns on CLOCK_MONOTONIC."""
        return int((self.origin + t) * 1e9)

    def stop(self) -> None:
        """Let `run` return."""
        self.stopped = True

    def stall(self, seconds: float) -> None:
        """Do nothing at all for `seconds`, as a process that gets no processor."""
        time.sleep(seconds)

    def run(self) -> None:
        """Serve until stopped."""
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0)
        agenda = self.agenda
        while not self.stopped:
            now = time.monotonic() - self.origin
            due = agenda.next
            if due < now:
                self.late = max(self.late, now - due)
            agenda.run_until(now)
            wait = max(0.0, min(LONGEST, agenda.next - (time.monotonic() - self.origin)))
            waiting = [source for source in self._sources if source.wants()]
            ready = select.select(waiting, [], [], wait)[0]
            if ready:
                agenda.run_until(time.monotonic() - self.origin)
            for source in ready:
                if source in self._sources:  # another one may have closed it
                    source.ready()
