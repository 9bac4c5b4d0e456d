"""A loop that stands still between ticks until it is told to go on: run in a thread, never beside anybody else."""

from __future__ import annotations

import threading
from collections.abc import Callable

from rig.core.clock import Clock
from rig.core.errors import HdrigError
from rig.loop import Ending
from sim.wire.inprocess import VirtualWire


class PuppetClock(Clock):
    """The wire's virtual time; whoever waits for a tick on the loop's thread waits for `step` first."""

    def __init__(self, wire: VirtualWire) -> None:
        self.wire = wire
        self.body: threading.Thread | None = None
        self._go, self._back = threading.Semaphore(0), threading.Semaphore(0)
        self.ended: Ending | HdrigError | BaseException | None = None

    def now(self) -> float:
        return self.wire.now()

    def wait_until(self, t: float) -> float:
        if threading.current_thread() is self.body:
            self._back.release()
            self._go.acquire()
        return self.wire.wait_until(t)

    def relax(self) -> bool:
        return self.wire.relax()

    @property
    def alive(self) -> bool:
        """A loop has been started and has not ended."""
        return self.body is not None

    def start(self, run: Callable[[], Ending]) -> None:
        """Up to where it first waits."""

        def body() -> None:
            self._go.acquire()
            try:
                self.ended = run()
            except BaseException as error:  # noqa: BLE001 - told to the test, in its own thread
                self.ended = error
            self.body = None
            self._back.release()

        self.body = threading.Thread(target=body, daemon=True)
        self.body.start()
        self.step()

    def step(self) -> None:
        """On to the next wait, or to the end."""
        if self.alive:
            self._go.release()
            self._back.acquire()
