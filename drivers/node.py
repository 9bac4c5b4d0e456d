"""What every CANopen node shares: identity, configuration verified by read-back, PDOs, heartbeat and emergencies.

SDO is canopen's, but in the caller's thread: its queue of answers takes frames from the bus itself, so that no receive
thread is needed, before a run or in it.
"""

from __future__ import annotations

import contextlib
import logging
import math
import queue
import struct
from typing import Any, NamedTuple

import can
import canopen
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from drivers.bus import HEARTBEAT, Bus, Frame
from rig.core.devices import Identity
from rig.core.errors import NotReady

logging.getLogger("canopen").setLevel(logging.CRITICAL)  # it logs what we say in sentences

NODES = range(1, 128)
START, PRE_OPERATIONAL = 0x01, 0x80  # NMT commands
BOOT_UP, STOPPED, OPERATIONAL, PREOP = 0x00, 0x04, 0x05, 0x7F  # NMT states in a heartbeat
NMT_NAMES = {BOOT_UP: "boot-up", STOPPED: "stopped", OPERATIONAL: "operational", PREOP: "pre-operational"}
SETTLE = 0.02  # s for a node that says nothing of its state to become what it was told
PRODUCE = 50  # ms between a node's heartbeats
PATIENCE = 3.5  # heartbeats that may stay away
TRIES = 5  # questions of 0.3 s each before a node is not there: some take a second to boot
TWICE = 5  # answers more than there were SYNCs that are no accident
OWED = 200  # answers at most that a node held up may give all at once, later
NO_OBJECT = 0x06020000  # abort code
UNSURE = {0x05040000}  # abort codes that are no answer: the node itself ran out of time
MISSING = object()


class Refused(NotReady):
    """The node answered, with no. Other ways may lead there."""


class Mapped(NamedTuple):
    """One object in a PDO."""

    at: int  # index
    sub: int
    bits: int
    form: str = ""  # of its number, as struct writes it


class _Answers(queue.Queue[bytes]):
    """SDO answers, fetched from the bus by whoever waits for them."""

    def __init__(self, bus: Bus) -> None:
        super().__init__()
        self._bus = bus

    def empty(self) -> bool:
        """Asked before each request: what came too late for the last one is thrown away."""
        self._bus.drain()
        while self.qsize():
            super().get(block=False)
        return True

    def get(self, block: bool = True, timeout: float | None = None) -> bytes:
        """The next answer. Raises queue.Empty."""
        if not self._bus.wait(timeout or 0.0, lambda: self.qsize() > 0):
            raise queue.Empty
        return super().get(block=False)


class Node:
    """One node on a bus. `who` is what errors call it."""

    def __init__(self, bus: Bus, number: int, who: str) -> None:
        self.bus = bus
        self.number = number
        self.who = f"{who} (node {number} on CAN bus '{bus.name}')"
        self.remarks: list[str] = []  # what a person should know of it, one sentence each
        self.emergency = ""  # the first one since `forget`, in words
        self.rebooted = False  # since `forget`
        self.beats = True  # it sends heartbeats
        self.state: int | None = None  # NMT state it last told
        self.heard = float("-inf")  # s on the loop's clock, last heartbeat
        self._sdo: Any = None
        self._number = 0  # of the frame seen last
        self._syncs = 0  # sent until then
        self._excess = 0  # answers more than SYNCs; below 0: those it still owes

    def open(self) -> None:
        """Open the bus and listen to the node; it is asked nothing yet. Raises NotReady."""
        if self.number not in NODES:
            raise NotReady(f"{self.who}: CANopen has nodes 1 to {NODES[-1]}")
        self.bus.open()
        network = canopen.Network()
        network.bus = self.bus.raw
        remote = canopen.RemoteNode(self.number, canopen.ObjectDictionary())  # type: ignore[no-untyped-call]
        remote.associate_network(network)
        self._sdo = remote.sdo
        self._sdo.responses = _Answers(self.bus)
        self.bus.listeners[0x580 + self.number] = self._on_answer
        self.bus.listeners[0x080 + self.number] = self._on_emergency
        self.bus.listeners[HEARTBEAT + self.number] = self._on_heartbeat

    def patience(self, seconds: float) -> None:
        """How long an answer may take from now on; canopen's own 0.3 s until then."""
        self._sdo.RESPONSE_TIMEOUT = seconds

    def forget(self) -> None:
        """Emergencies, reboots and doubled answers so far are no longer news."""
        self.emergency, self.rebooted, self._excess = "", False, 0

    def revive(self) -> None:
        """Forget what it told. Raises NotReady when it has lost its configuration meanwhile."""
        if self.rebooted:
            raise NotReady(f"{self.who} rebooted: disconnect and connect again, its configuration is lost")
        self.forget()

    def identify(self, profile: int) -> Identity:
        """Device type, name, serial number and version. Raises NotReady when it is no `profile` device."""
        self._await()
        kind = self.read_uint(0x1000) & 0xFFFF
        if kind != profile:
            raise NotReady(f"{self.who} says it is a CiA {kind} device (1000h), expected CiA {profile}")
        name, version = self.text(0x1008), self.text(0x100A)
        vendor, product, revision, serial = (self.read_uint(0x1018, sub, default=0) for sub in (1, 2, 3, 4))
        model = name or f"vendor {vendor:#x} product {product:#x}"
        return Identity(model, str(serial or ""), version or f"{revision:#x}")

    def _await(self) -> None:
        """Until it answers at all. Raises NotReady when it has had the time to boot."""
        said = ""
        for _ in range(TRIES):
            try:
                self.read(0x1000, 0, b"")
            except NotReady as why:
                said = str(why)
                continue
            return
        raise NotReady(f"{said}; `hdrig devices` asks every node")

    def read(self, index: int, sub: int = 0, default: Any = MISSING) -> bytes:
        """An object's bytes; `default` where the node will not tell, whatever code it says so with: nodes do not agree
        on what "no such object" is. Raises NotReady.
        """
        try:
            return bytes(self._sdo.upload(index, sub))
        except SdoAbortedError as why:
            if why.code not in UNSURE and default is not MISSING:
                return default  # type: ignore[no-any-return]
            raise Refused(f"{self.who} refused to read {index:04X}h:{sub}: {why}") from None
        except (SdoCommunicationError, can.CanError) as why:
            told = f"{self.who} does not answer (reading {index:04X}h:{sub}: {why})"
            raise NotReady(told + self.bus.silence(-math.inf)) from None

    def lacks(self, index: int) -> bool:
        """The node says, by the standard's own code, that there is no such object. Raises NotReady: it is silent."""
        try:
            self._sdo.upload(index, 0)
        except SdoAbortedError as why:
            return bool(why.code == NO_OBJECT)
        except (SdoCommunicationError, can.CanError) as why:
            raise NotReady(f"{self.who} does not answer (reading {index:04X}h: {why})") from None
        return False

    def read_uint(self, index: int, sub: int = 0, default: int | None = None) -> int:
        """An unsigned number, whatever its size. Raises NotReady."""
        raw = self.read(index, sub, MISSING if default is None else default.to_bytes(8, "little"))
        return int.from_bytes(raw, "little")

    def read_int(self, index: int, sub: int = 0) -> int:
        """A signed number. Raises NotReady."""
        return int.from_bytes(self.read(index, sub), "little", signed=True)

    def text(self, index: int) -> str:
        """A string, "" when there is none."""
        return self.read(index, 0, b"").decode(errors="replace").strip("\0 ")

    def write(self, index: int, sub: int, value: bytes) -> None:
        """Write an object and read it back. Raises NotReady when refused, or when it reads back differently."""
        self.put(index, sub, value)
        back = self.read(index, sub)
        if back[: len(value)] != value:
            raise Refused(
                f"{self.who}: wrote {value[::-1].hex()}h to {index:04X}h:{sub}, it reads back {back[::-1].hex()}h"
            )

    def write_if_there(self, index: int, sub: int, value: bytes) -> bool:
        """As `write`; False when the node has no such object. Raises NotReady."""
        try:
            self._sdo.upload(index, sub)
        except SdoAbortedError as why:
            if why.code not in UNSURE:
                return False
        except (SdoCommunicationError, can.CanError):
            pass  # said by the write
        self.write(index, sub, value)
        return True

    def restore(self, index: int, sub: int, value: bytes) -> None:
        """Put back what was there, if the node lets us. Never raises."""
        with contextlib.suppress(NotReady):
            self.put(index, sub, value)

    def put(self, index: int, sub: int, value: bytes) -> None:
        """Write an object that is not to be read back. Raises NotReady."""
        try:
            self._sdo.download(index, sub, value)
        except SdoAbortedError as why:
            raise Refused(f"{self.who} refused {index:04X}h:{sub} = {value[::-1].hex()}h: {why}") from None
        except (SdoCommunicationError, can.CanError) as why:
            raise NotReady(f"{self.who} does not answer (writing {index:04X}h:{sub}: {why})") from None

    def produce_heartbeat(self) -> None:
        """Have the node tell that it lives. One that cannot is told by the age of its PDOs alone. Raises NotReady."""
        try:
            self.write(0x1017, 0, struct.pack("<H", PRODUCE))
        except Refused as why:
            self.beats = False
            self.remarks.append(f"{self.who} has no heartbeat ({why}): only the age of its PDOs shows that it lives")

    def start(self) -> None:
        """Operational, confirmed by its heartbeat; an error it shows is remarked on. Raises NotReady."""
        self._nmt(START, OPERATIONAL)
        if register := self.read_uint(0x1001, default=0):
            told = f", {self.emergency.rpartition(': ')[2]}" if self.emergency else ""
            self.remarks.append(
                f"{self.who} shows an error, 1001h = {register:02X}h{told}: look at it before you trust it"
            )

    def pause(self) -> None:
        """Pre-operational: PDOs off, while it is being configured. Raises NotReady."""
        self.bus.nmt(PRE_OPERATIONAL, self.number)
        self.bus.wait(0.002, lambda: False)  # it has no answer; some nodes drop an SDO that follows at once

    def _nmt(self, command: int, wanted: int) -> None:
        self.state = None
        self.bus.nmt(command, self.number)
        if not self.beats:
            self.bus.wait(SETTLE, lambda: False)
            return
        if not self.bus.wait(PATIENCE * PRODUCE / 1000, lambda: self.state == wanted):
            told = "nothing" if self.state is None else NMT_NAMES.get(self.state, f"state {self.state:#x}")
            raise NotReady(f"{self.who} did not become {NMT_NAMES[wanted]}; its heartbeat says {told}")

    def aside(self, now: float) -> bool:
        """It lives, and says that it is not operational: it takes and tells no PDOs."""
        return self.beats and now - self.heard < PATIENCE * PRODUCE / 1000 and self.state != OPERATIONAL

    def answered(self, frame: Frame) -> None:
        """Its newest answer to a SYNC: two nodes of one number both answer, a single frame may come twice by error.

        Who was held up answers several at once, a few at a time: what it owed is taken off.
        """
        answers, syncs = frame.number - self._number, self.bus.syncs - self._syncs
        self._excess = max(self._excess + answers - syncs, -OWED)
        self._number, self._syncs = frame.number, self.bus.syncs

    def trouble(self, now: float) -> str:
        """What is wrong with the node as such, in words; "" when nothing is."""
        if self.bus.dead:
            return self.bus.dead
        if self._excess > TWICE:
            return f"every SYNC is answered twice for {self.who}: are there two nodes of this number?"
        if self.rebooted:
            return f"{self.who} rebooted: its configuration and position are lost"
        if self.emergency:
            return self.emergency
        if not self.beats:
            return ""
        if now - self.heard > PATIENCE * PRODUCE / 1000:
            told = f"no heartbeat of {self.who} for {PATIENCE * PRODUCE:.0f} ms, expected one every {PRODUCE} ms"
            return told + self.bus.silence(now - 2 * PRODUCE / 1000)
        if self.state != OPERATIONAL:
            told = NMT_NAMES.get(self.state or 0, f"NMT state {self.state}")
            return f"{self.who} is {told}, expected operational"
        return ""

    def _on_answer(self, data: bytes, t: float) -> None:
        if len(data) == 8:  # every SDO answer has; canopen breaks on others
            self._sdo.responses.put(data)

    def _on_heartbeat(self, data: bytes, t: float) -> None:
        if len(data) != 1:
            return
        self.heard, self.state = t, data[0] & 0x7F
        self.rebooted |= data[0] == BOOT_UP

    def _on_emergency(self, data: bytes, t: float) -> None:
        code = int.from_bytes(data[:2], "little") if len(data) >= 2 else 0
        if code and not self.emergency:
            self.emergency = f"{self.who}: emergency {code:04X}h, {emergency_text(code)}"


EMERGENCIES = {
    0x1000: "generic error",
    0x2000: "current",
    0x3000: "voltage",
    0x4000: "temperature",
    0x5000: "device hardware",
    0x6000: "device software",
    0x7000: "additional modules",
    0x8000: "monitoring",
    0x8100: "communication",
    0x8110: "CAN overrun, frames lost",
    0x8120: "CAN in error-passive mode",
    0x8130: "heartbeat or life guarding of this host was missed",
    0x8140: "recovered from bus-off",
    0x8200: "protocol error",
    0x8210: "PDO not processed, wrong length",
    0x8250: "RPDO timeout: the commands stayed away",
    0x8400: "speed control",
    0x8500: "position control",
    0x8600: "position control",
    0x8611: "following error",
    0x9000: "external error",
    0xFF00: "device specific",
}


def emergency_text(code: int) -> str:
    """What an error code means, by the finest class the standard names      [cia301, 7.2.7]"""
    for mask in (0xFFFF, 0xFFF0, 0xFF00, 0xF000):
        if code & mask in EMERGENCIES:
            return EMERGENCIES[code & mask]
    return "a code of the maker's"
