"""How a node and its host watch each other: heartbeats 1016 and 1017, guarding 100C and 100D      [cia301]"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import final

from sim.wire.agenda import Agenda, Timer
from sim.wire.frame import REMOTE
from sim.wire.objects import U8, U16, U32, Entry, Objects

HEARTBEAT = 0x700  # plus the node's number


class State(IntEnum):
    """NMT states as the heartbeat says them."""

    INITIALISING = 0
    STOPPED = 4
    OPERATIONAL = 5
    PRE_OPERATIONAL = 127


@final
class Watch:
    """`send` takes identifier and data, `lost` is called when the host is silent, `changed` when another one counts."""

    def __init__(
        self,
        objects: Objects,
        agenda: Agenda,
        node_id: int,
        send: Callable[[int, bytes], None],
        changed: Callable[[], None],
        lost: Callable[[], None],
    ) -> None:
        self._identifier, self._send, self._changed = HEARTBEAT + node_id, send, changed
        self.state = State.INITIALISING
        self._toggle = 0
        self._beat_timer = Timer(agenda, self._beat)
        self._host = Timer(agenda, lost)
        self._guard_time = objects.add(0x100C, Entry(U16))  # ms
        self._life_factor = objects.add(0x100D, Entry(U8))
        self._consumer = Entry(U32, 0, write=self._set_consumer)  # node << 16 | ms
        objects.record(0x1016, {1: self._consumer})
        self._producer = objects.add(0x1017, Entry(U16, 0, write=self._set_producer))  # ms

    def boot(self) -> None:
        """Say that the node is there; heartbeats follow where they are wanted."""
        self._send(self._identifier, b"\0")
        self.state = State.PRE_OPERATIONAL
        self._set_producer(self._producer.number)

    def rest(self) -> None:
        """The power fails."""
        self._beat_timer.stop()
        self._host.stop()

    def handlers(self) -> dict[int, Callable[[bytes], None]]:
        """What is to be called with which frames."""
        found: dict[int, Callable[[bytes], None]] = {self._identifier | REMOTE: self._guarded}
        watched = self._consumer.number >> 16 & 0x7F
        if watched:
            found[HEARTBEAT + watched] = self._heard
        return found

    def _set_producer(self, milliseconds: float) -> None:
        if milliseconds and self.state is not State.INITIALISING:
            self._beat_timer.start(milliseconds * 1e-3)
        else:
            self._beat_timer.stop()

    def _beat(self) -> None:
        self._send(self._identifier, bytes([self.state]))
        self._set_producer(self._producer.number)

    def _guarded(self, data: bytes) -> None:
        self._send(self._identifier, bytes([self._toggle | self.state]))
        self._toggle ^= 0x80
        self._expect(self._guard_time.number * self._life_factor.number)

    def _set_consumer(self, value: float) -> None:
        self._host.stop()
        self._consumer.value = int(value)
        self._changed()

    def _heard(self, data: bytes) -> None:
        self._expect(self._consumer.number & 0xFFFF)

    def _expect(self, milliseconds: int) -> None:
        """The host is alive and has to be heard again within that time; the first time starts the watch."""
        if milliseconds:
            self._host.start(milliseconds * 1e-3)
