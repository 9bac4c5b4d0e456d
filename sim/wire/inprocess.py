"""The twin on the wire in this very process: its clock is virtual, its bus is python-can's, and no byte is left out."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import Any, final

from rig.core.can_libraries import can
from rig.core.clock import Clock
from sim.wire.assembly import Assembly
from sim.wire.bus import Bus
from sim.wire.frame import EXTENDED, REMOTE, Frame

RELAX = 0.001  # s of wall time, for other processes to catch up
IDENTIFIER = (1 << 29) - 1


@final
class VirtualWire(Clock):
    """Time passes, on the bus and in the plant, only while somebody waits for it, or for a frame."""

    def __init__(self, assembly: Assembly) -> None:
        self.assembly = assembly
        self._stalled = 0.0  # s by which the next wait ends too late

    def stall(self, seconds: float) -> None:
        """Whoever waits next gets the processor so much too late."""
        self._stalled = seconds

    def now(self) -> float:
        """s since the twin was switched on."""
        return self.assembly.agenda.now

    def wait_until(self, t: float) -> float:
        """Let frames pass and the plant move until `t` s."""
        self.assembly.agenda.run_until(t)
        if self._stalled:
            late, self._stalled = self._stalled, 0.0
            self.assembly.agenda.run_until(t + late)
        return self.assembly.agenda.now

    def relax(self) -> bool:
        """Time is held here; other processes get a moment."""
        time.sleep(RELAX)
        return True

    def connect(self, **_: Any) -> InProcessBus:
        """In place of `can.Bus`."""
        return InProcessBus(self.assembly.bus)

    def door(self, bus: Bus) -> Callable[..., InProcessBus]:
        """In place of `can.Bus`, to another bus of the same time."""
        return lambda **_: InProcessBus(bus)


@final
class InProcessBus(can.BusABC):
    """A station on the twin's bus, as python-can sees one."""

    def __init__(self, bus: Bus) -> None:
        super().__init__(channel="in this process")
        self._agenda = bus.agenda
        self._frames: deque[tuple[Frame, float]] = deque()
        self.port = bus.attach("host", lambda frame, t: self._frames.append((frame, t)))

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Queue a frame; it passes when the bus is free."""
        flags = msg.is_extended_id * EXTENDED | msg.is_remote_frame * REMOTE
        self.port.send(Frame(msg.arbitration_id | flags, bytes(msg.data)))

    def flush_tx_buffer(self) -> None:
        """What waits is thrown away."""
        self.port.queue.clear()

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """The next frame; waits in virtual time. python-can's own would wait in real time."""
        until = self._agenda.now + (timeout or 0.0)
        while not self._frames and self._agenda.next <= until:
            self._agenda.run_until(self._agenda.next)
        if not self._frames:
            self._agenda.run_until(until)
            return None
        (identifier, data), passed = self._frames.popleft()
        return can.Message(
            timestamp=passed,
            arbitration_id=identifier & IDENTIFIER,
            is_extended_id=bool(identifier & EXTENDED),
            is_remote_frame=bool(identifier & REMOTE),
            data=b"" if identifier & REMOTE else data,
        )

    def shutdown(self) -> None:
        """Leave the bus. Idempotent."""
        if not self._is_shutdown:
            self.port.leave()
        super().shutdown()
