"""Process data objects of a node: communication parameters, mapping with the standard's rules, sending, taking.

A mapping is changed as CiA 301 asks: switch the PDO off (bit 31 of its COB-ID), write 0 entries, write the entries,
write their number, switch it on. Other orders are aborted      [cia301, PDO communication and mapping parameter]
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import NamedTuple, final

from sim.wire.agenda import Agenda, Timer
from sim.wire.objects import U8, U16, U32, Abort, AbortCode, Entry, Objects

OFF = 1 << 31  # of a COB-ID: the PDO does not exist
NO_REMOTE = 1 << 30  # of a TPDO's COB-ID: not to be asked for by a remote frame
LONG = 1 << 29  # of a COB-ID: a 29-bit identifier, which these nodes do not do
SLOTS = 8  # entries a PDO may have: each is a byte at least
BYTES = 8
LAST_SYNC = 240  # transmission types up to here follow SYNC
EVENTS = (254, 255)


class PdoDefault(NamedTuple):
    """What a PDO is after power-up: COB-ID, transmission type, mapped objects as index << 16 | sub << 8 | bits."""

    cob: int
    transmission: int
    mapped: Sequence[int]
    timer_ms: int = 0

    def of_node(self, more: int) -> PdoDefault:
        """The same with `more` added to the COB-ID: the node's number, bits."""
        return self._replace(cob=self.cob + more)


class Pdo(ABC):
    """What both directions share. `changed` is called when the COB-ID is."""

    reading: bool  # of the mapped entries

    def __init__(
        self, objects: Objects, communication: int, default: PdoDefault, agenda: Agenda, changed: Callable[[], None]
    ) -> None:
        self.objects, self.agenda, self._changed = objects, agenda, changed
        self.cob = Entry(U32, default.cob, write=self._set_cob)
        self.transmission = Entry(U8, default.transmission, write=self._set_transmission)
        self.inhibit = Entry(U16)  # 100 µs
        self.timer = Entry(U16, default.timer_ms, write=self._set_timer)  # ms
        self.count = Entry(U8, len(default.mapped), write=self._set_count)
        slots = [*default.mapped, *[0] * (SLOTS - len(default.mapped))]
        self.slots = [Entry(U32, mapped, write=self._set_slot) for mapped in slots]
        objects.record(communication, {1: self.cob, 2: self.transmission, 3: self.inhibit, 5: self.timer})
        objects.add(communication + 0x200, self.count)
        for sub, slot in enumerate(self.slots, 1):
            objects.add(communication + 0x200, slot, sub)
        self.entries: list[Entry] = []
        self.size = 0

    @property
    def on(self) -> bool:
        """Whether it exists."""
        return not self.cob.number & OFF

    @property
    def identifier(self) -> int:
        """11 bits."""
        return self.cob.number & 0x7FF

    def refresh(self) -> None:
        """Look the mapped entries up again, after values were put in without the rules."""
        self._look_up(self.count.number)

    @abstractmethod
    def rest(self) -> None:
        """Forget what is under way: the node stopped, or the PDO was changed."""

    def _set_cob(self, value: float) -> None:
        cob = int(value)
        if cob & LONG or (self.on and not cob & OFF and cob != self.cob.number):
            raise Abort(AbortCode.VALUE)
        self.cob.value = cob
        self.rest()
        self._changed()

    def _set_transmission(self, value: float) -> None:
        if LAST_SYNC < value < EVENTS[0]:
            raise Abort(AbortCode.VALUE)
        self.rest()

    def _set_timer(self, value: float) -> None:
        self.rest()

    def _set_count(self, value: float) -> None:
        if self.on:
            raise Abort(AbortCode.UNSUPPORTED)
        if value > SLOTS:
            raise Abort(AbortCode.MAP_TOO_LONG)
        self._look_up(int(value))

    def _set_slot(self, value: float) -> None:
        if self.on or self.count.number:
            raise Abort(AbortCode.UNSUPPORTED)
        self._mapped(int(value))

    def _look_up(self, count: int) -> None:
        entries = [self._mapped(slot.number) for slot in self.slots[:count]]
        size = sum(entry.kind.size for entry in entries)
        if size > BYTES:
            raise Abort(AbortCode.MAP_TOO_LONG)
        self.entries, self.size = entries, size

    def _mapped(self, slot: int) -> Entry:
        entry = self.objects.find(slot >> 16, slot >> 8 & 0xFF)
        fits = entry.readable if self.reading else entry.writable
        if not (entry.mappable and fits and 8 * entry.kind.size == slot & 0xFF):
            raise Abort(AbortCode.NOT_MAPPABLE)
        return entry


@final
class Tpdo(Pdo):
    """Sent on every n-th SYNC (types 1 to 240), or on events and by a timer (254, 255)."""

    reading = True

    def __init__(
        self,
        objects: Objects,
        number: int,
        default: PdoDefault,
        agenda: Agenda,
        changed: Callable[[], None],
        send: Callable[[int, bytes], None],
    ) -> None:
        super().__init__(objects, 0x1800 + number, default, agenda, changed)
        self._send = send
        self._syncs = 0
        self._quiet_until = 0.0  # s, the inhibit time
        self._waiting = False
        self._clock = Timer(agenda, self._transmit)
        self._later = Timer(agenda, self._transmit)

    def rest(self) -> None:
        self._syncs, self._waiting = 0, False
        self._clock.stop()
        self._later.stop()

    def begin(self) -> None:
        """The node became operational."""
        self.rest()
        if self.on and self.transmission.number in EVENTS:
            self._transmit()

    def sync(self) -> None:
        """A SYNC has passed."""
        every = self.transmission.number
        if not self.on or every > LAST_SYNC:
            return
        self._syncs += 1
        if (every and self._syncs >= every) or (not every and self._waiting):
            self._syncs, self._waiting = 0, False
            self._transmit()

    def event(self, entry: Entry) -> None:
        """The value of `entry` has changed of itself."""
        if not self.on or entry not in self.entries:
            return
        self._waiting = True
        if self.transmission.number in EVENTS:
            self._later.start(max(0.0, self._quiet_until - self.agenda.now))

    def _transmit(self) -> None:
        self._send(self.identifier, b"".join([entry.data() for entry in self.entries]))
        if self.transmission.number in EVENTS:
            self._quiet_until = self.agenda.now + self.inhibit.number * 1e-4
            if self.timer.number:
                self._clock.start(self.timer.number * 1e-3)


@final
class Rpdo(Pdo):
    """Taken at the next SYNC (types 0 to 240) or at once. With an event timer, silence after the first is told."""

    reading = False

    def __init__(
        self,
        objects: Objects,
        number: int,
        default: PdoDefault,
        agenda: Agenda,
        changed: Callable[[], None],
        missing: Callable[[], None],
        short: Callable[[], None],
    ) -> None:
        super().__init__(objects, 0x1400 + number, default, agenda, changed)
        self._deadline = Timer(agenda, missing)
        self._short = short
        self._held: bytes | None = None

    def rest(self) -> None:
        self._held = None
        self._deadline.stop()

    def receive(self, data: bytes) -> None:
        """A frame of ours. Too short a one is not used at all; of a longer one the first bytes are."""
        if len(data) < self.size:
            self._short()
            return
        if self.timer.number:
            self._deadline.start(self.timer.number * 1e-3)
        if self.transmission.number <= LAST_SYNC:
            self._held = data
        else:
            self._take(data)

    def sync(self) -> None:
        """A SYNC has passed."""
        if self._held is not None:
            data, self._held = self._held, None
            self._take(data)

    def _take(self, data: bytes) -> None:
        start = 0
        for entry in self.entries:
            part = data[start : start + entry.kind.size]
            start += entry.kind.size
            try:
                entry.accept(part)
            except Abort:
                continue  # a value the object does not take is dropped, the rest of the PDO is not
