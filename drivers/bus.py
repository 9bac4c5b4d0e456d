"""One CAN bus, read and written in the caller's own thread: no receive thread dies unseen, no sender runs on alone."""

from __future__ import annotations

import contextlib
import math
import select
import struct
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from drivers.claim import connect_alone
from drivers.queueing import Queueing
from drivers.unopened import first_line, why_unopened
from rig.core.can_libraries import can
from rig.core.clock import NEVER, Clock
from rig.core.errors import NotReady

SYNC, HEARTBEAT, NMT = 0x080, 0x700, 0x000
OPERATIONAL = 0x05
CANOPEN = "CANopen"
MOST = 500  # frames taken in one go: a babbling node must not hold the loop for longer than some milliseconds
LATE_ANSWER = 0.002  # s before the newest SYNC: who answered then answered an older one, and was held up on the way
SETTLE, OTHERS = 0.01, 0.12  # s listened before anything is sent: a host that only reads beats every 50 ms
GARBLED = (ValueError, IndexError, struct.error)  # what slcan and serial backends raise on a torn line
GONE = (can.CanError, OSError)


class Frame(NamedTuple):
    """The newest frame of one identifier."""

    arrived: float  # s on the clock of the loop: by the adapter's time stamp, else when it was taken from the queue
    latched: float  # s, when the SYNC it answers was sent; of an answer held up on its way, when it passed on the bus
    data: bytes
    number: int  # frames of this identifier so far


class Bus:
    """A bus under python-can's name for its interface. Frames are taken when `drain` is called, never otherwise.

    After a failed send or receive the bus is dead and stays so until it is opened again: what the system queued
    meanwhile is thrown away with the socket, so that no old target reaches a drive.
    """

    def __init__(
        self,
        name: str,
        interface: str,
        channel: str,
        clock: Clock,
        options: Mapping[str, Any],
        connect: Callable[..., Any] = connect_alone,
    ) -> None:
        self.name = name
        self.protocol = CANOPEN  # what its devices speak
        self.requests: list[int] = []  # identifiers asked for at every latch, where there is no SYNC
        self._connect = connect
        self._queueing = Queueing()
        self.clock = clock
        self.frames: dict[int, Frame] = {}
        self.listeners: dict[int, Callable[[bytes, float], None]] = {}
        self.dead = ""  # why, in words
        self.garbled = 0  # lines or frames that made no sense
        self.errors = 0  # error frames of the controller
        self.host_node = 0  # CANopen node number of this host, 0: it sends no heartbeat
        self.heartbeat = 0.02  # s between heartbeats of this host
        self.mute = False  # no heartbeat of this host: a drive that did not confirm its stop is to notice that
        self.synced = NEVER  # s, when the last SYNC was sent
        self.syncs = 0  # sent so far
        self._where = (interface, channel, dict(options))
        self._can: Any = None
        self._poll: select.poll | None = None  # of its bytes, where it is more than a part of this process
        self._beat = NEVER
        self._messages: dict[int, can.Message] = {}
        self._asks: dict[int, can.Message] = {}

    @property
    def is_open(self) -> bool:
        """True between `open` and `close`."""
        return self._can is not None

    def open(self) -> None:
        """Open it; nothing when it is. Raises NotReady, one sentence, whatever the backend raises, and where another
        program is heard there that commands it, through whatever adapter.
        """
        if self._can is not None:
            return
        interface, channel, options = self._where
        try:
            self._can = self._connect(interface=interface, channel=channel, **options)
        except (Exception, SystemExit) as why:  # noqa: BLE001  each backend of python-can raises what it likes
            reason = why_unopened(interface, why)
            raise NotReady(f"CAN bus '{self.name}' ({interface} {channel}) could not be opened: {reason}") from None
        self._poll = _poll_of(self._can)
        self.frames.clear()
        self.dead, self.mute, self.synced, self._beat = "", False, NEVER, NEVER
        if self.host_node and self.protocol == CANOPEN:
            self._refuse_other_host()

    def _refuse_other_host(self) -> None:
        """A lock on a channel holds nobody off who came by another one: two adapters, one bus."""
        beat = HEARTBEAT + self.host_node
        self.wait(SETTLE, lambda: False)  # what an adapter kept from before
        self.drain()
        self.frames.clear()
        self.wait(OTHERS, lambda: beat in self.frames)
        if beat in self.frames:
            self.close()
            raise NotReady(
                f"CAN bus '{self.name}' has a host already: somebody sends the heartbeat of node {self.host_node}, "
                "ours; one program at a time commands a bench: end that one first, or give host_node another number "
                "where it is a device"
            )
        self.frames.clear()

    def close(self) -> None:
        """Leave the bus. Idempotent; never raises."""
        bus, self._can, self._poll = self._can, None, None
        if bus is not None:
            with contextlib.suppress(*GONE, *GARBLED):
                bus.shutdown()

    def send(self, identifier: int, data: bytes) -> bool:
        """One data frame with an 11-bit identifier; False when the bus is dead, or by this became so. Never raises."""
        if self._can is None or self.dead:
            return False
        message = self._messages.get(identifier)
        if message is None:
            # python-can's default is a 29-bit identifier, which no CANopen node hears
            message = self._messages[identifier] = can.Message(arbitration_id=identifier, is_extended_id=False)
        message.data, message.dlc = bytearray(data), len(data)
        return self._hand_over(message)

    def ask(self, identifier: int) -> bool:
        """A remote frame: whoever has that identifier answers with its 8 bytes. As `send`."""
        if self._can is None or self.dead:
            return False
        message = self._asks.get(identifier)
        if message is None:
            message = can.Message(arbitration_id=identifier, is_extended_id=False, is_remote_frame=True, dlc=8)
            self._asks[identifier] = message
        return self._hand_over(message)

    def _hand_over(self, message: can.Message) -> bool:
        try:
            self._can.send(message)
        except GONE as why:
            self.dead = f"CAN bus '{self.name}' takes no frames any more ({first_line(why)})"
            return False
        return True

    def silence(self, since: float) -> str:
        """What follows a complaint about one device where no other was heard after `since` [s] either; else ""."""
        if any(frame.arrived > since for frame in self.frames.values()):
            return ""
        return f"; nobody is heard on CAN bus '{self.name}' (cable, power, bitrate?)"

    def discard(self) -> None:
        """Throw away what waits to be sent, where the adapter can: old targets must not follow a stop. Never raises."""
        if self._can is not None:
            with contextlib.suppress(NotImplementedError, *GONE):
                self._can.flush_tx_buffer()

    def drain(self) -> None:
        """Take what has arrived, without waiting. Never raises."""
        for _ in range(MOST):
            if not self.take(0.0) and not self._more():
                return

    def _more(self) -> bool:
        """Bytes wait all the same: slcan hands over nothing, once, for every word by which the adapter confirms a frame
        of ours, with the answers of the devices behind it.
        """
        return not self.dead and self._poll is not None and bool(self._poll.poll(0))

    def wait(self, seconds: float, done: Callable[[], bool]) -> bool:
        """Take frames for up to `seconds` until `done` says so; what it says at the end. Not for use in a tick."""
        until = self.clock.now() + seconds
        while not done():
            remaining = until - self.clock.now()
            if remaining <= 0 or self.dead:
                return False
            self.take(remaining)
        return True

    def take(self, timeout: float) -> bool:
        """One frame, waiting up to `timeout` s for it. False when there was none. Never raises."""
        if self._can is None or self.dead:
            return False
        try:
            message = self._can.recv(0.0) or (self._recv(timeout) if timeout > 0.0 else None)
        except GARBLED:
            self.garbled += 1
            return True
        except GONE as why:
            self.dead = f"CAN bus '{self.name}' is lost ({first_line(why)})"
            return False
        if message is None:
            return False
        if message.is_error_frame:
            self.errors += 1
        elif not (message.is_extended_id or message.is_remote_frame):
            self._keep(message.arbitration_id, bytes(message.data), message.timestamp)
        return True

    def _recv(self, timeout: float) -> can.Message | None:
        """Asleep until something comes: who looks again and again keeps the adapter from the processor."""
        if self._poll is not None:
            self._poll.poll(math.ceil(1e3 * timeout))
        return self._can.recv(timeout if self._poll is None else 0.0)  # type: ignore[no-any-return]

    def _keep(self, identifier: int, data: bytes, stamp: float) -> None:
        taken = self.clock.now()
        now = taken - self._queueing.waited(taken, stamp)
        latched = self.synced if self.synced - now < LATE_ANSWER else now
        last, number = self.frames.get(identifier), 1
        if last is not None:  # none passes the one before it, however roughly they are stamped
            now, latched, number = max(now, last.arrived), max(latched, last.latched), last.number + 1
        self.frames[identifier] = Frame(now, latched, data, number)
        listener = self.listeners.get(identifier)
        if listener is not None:
            listener(data, now)

    def latch(self) -> None:
        """Have its devices take their readings now: by SYNC, else by asking each for its own. Never raises."""
        if self.protocol == CANOPEN:
            self.sync()
            return
        self.drain()
        for identifier in self.requests:
            self.ask(identifier)

    def sync(self) -> None:
        """Have every synchronous node latch now; this host's heartbeat when it is due. Never raises."""
        self.drain()  # what still comes from the last SYNC belongs to that one
        now = self.clock.now()
        if self.send(SYNC, b""):
            self.synced = now
            self.syncs += 1
        if self.host_node and not self.mute and now - self._beat >= self.heartbeat:
            self._beat = now
            self.send(HEARTBEAT + self.host_node, bytes((OPERATIONAL,)))

    def nmt(self, command: int, node: int) -> bool:
        """A network-management command to one node      [cia301, 7.2.8]"""
        return self.send(NMT, bytes((command, node)))

    @property
    def raw(self) -> Any:
        """python-can's bus, for canopen's SDO client."""
        return self._can


def _poll_of(bus: can.BusABC) -> select.poll | None:
    waiting = -1
    with contextlib.suppress(AttributeError, NotImplementedError):  # a bus within the process
        waiting = bus.fileno()
    if waiting < 0:
        return None
    found = select.poll()
    found.register(waiting, select.POLLIN)
    return found
