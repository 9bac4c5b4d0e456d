"""What every CANopen node shares: identity, heartbeat, NMT states, emergencies, what is wrong with it."""

from __future__ import annotations

import struct

from drivers.bus import HEARTBEAT, Bus, Frame
from drivers.emergencies import emergency_text
from drivers.sdo import Refused, Sdo
from rig.core.devices import Identity
from rig.core.errors import NotReady

NODES = range(1, 128)
START, STOP, PRE_OPERATIONAL = 0x01, 0x02, 0x80  # NMT commands
BOOT_UP, STOPPED, OPERATIONAL, PREOP = 0x00, 0x04, 0x05, 0x7F  # NMT states in a heartbeat
NMT_NAMES = {BOOT_UP: "boot-up", STOPPED: "stopped", OPERATIONAL: "operational", PREOP: "pre-operational"}
SETTLE = 0.02  # s for a node that says nothing of its state to become what it was told
PRODUCE = 50  # ms between a node's heartbeats
PATIENCE = 3.5  # heartbeats that may stay away
TRIES = 5  # questions of 0.3 s each before a node is not there: some take a second to boot
TWICE = 5  # answers more than there were SYNCs that are no accident
OWED = 200  # answers at most that a node held up may give all at once, later


class Node:
    """One node on a bus. `who` is what errors call it."""

    def __init__(self, bus: Bus, number: int, who: str) -> None:
        self.bus = bus
        self.number = number
        self.who = f"{who} (node {number} on CAN bus '{bus.name}')"
        self.sdo = Sdo(bus, number, self.who)
        self.remarks: list[str] = []  # what a person should know of it, one sentence each
        self.emergency = ""  # the first one since `forget`, in words
        self.rebooted = False  # since `forget`
        self.beats = True  # it sends heartbeats
        self.state: int | None = None  # NMT state it last told
        self.heard = float("-inf")  # s on the loop's clock, last heartbeat
        self._number = 0  # of the frame seen last
        self._syncs = 0  # sent until then
        self._excess = 0  # answers more than SYNCs; below 0: those it still owes

    def open(self) -> None:
        """Open the bus and listen to the node; it is asked nothing yet. Raises NotReady."""
        if self.number not in NODES:
            raise NotReady(f"{self.who}: CANopen has nodes 1 to {NODES[-1]}")
        self.bus.open()
        self.sdo.open()
        self.bus.listeners[0x080 + self.number] = self._on_emergency
        self.bus.listeners[HEARTBEAT + self.number] = self._on_heartbeat

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
        kind = self.sdo.read_uint(0x1000) & 0xFFFF
        if kind != profile:
            raise NotReady(f"{self.who} says it is a CiA {kind} device (1000h), expected CiA {profile}")
        name, version = self.sdo.text(0x1008), self.sdo.text(0x100A)
        vendor, product, revision, serial = (self.sdo.read_uint(0x1018, sub, default=0) for sub in (1, 2, 3, 4))
        model = name or f"vendor {vendor:#x} product {product:#x}"
        return Identity(model, str(serial or ""), version or f"{revision:#x}")

    def _await(self) -> None:
        """Until it answers at all. Raises NotReady when it has had the time to boot."""
        said = ""
        for _ in range(TRIES):
            try:
                self.sdo.read(0x1000, 0, b"")
            except NotReady as why:
                said = str(why)
                continue
            return
        raise NotReady(f"{said}; `hdrig devices` asks every node")

    def produce_heartbeat(self) -> None:
        """Have the node tell that it lives. One that cannot is told by the age of its PDOs alone. Raises NotReady."""
        try:
            self.sdo.write(0x1017, 0, struct.pack("<H", PRODUCE))
        except Refused as why:
            self.beats = False
            self.remarks.append(f"{self.who} has no heartbeat ({why}): only the age of its PDOs shows that it lives")

    def start(self) -> None:
        """Operational, confirmed by its heartbeat; an error it shows is remarked on. Raises NotReady."""
        self._nmt(START, OPERATIONAL)
        if register := self.sdo.read_uint(0x1001, default=0):
            told = f", {self.emergency.rpartition(': ')[2]}" if self.emergency else ""
            self.remarks.append(
                f"{self.who} shows an error, 1001h = {register:02X}h{told}: look at it before you trust it"
            )

    def pause(self) -> None:
        """Pre-operational: PDOs off, while it is being configured. Raises NotReady."""
        self.bus.nmt(PRE_OPERATIONAL, self.number)
        self.bus.wait(0.002, lambda: False)  # it has no answer; some nodes drop an SDO that follows at once

    def stop(self) -> None:
        """Stopped: to a drive that is a lost connection, which it has a reaction for (6007h). Never raises."""
        self.bus.nmt(STOP, self.number)

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

    def _on_heartbeat(self, data: bytes, t: float) -> None:
        if len(data) != 1:
            return
        self.heard, self.state = t, data[0] & 0x7F
        self.rebooted |= data[0] == BOOT_UP

    def _on_emergency(self, data: bytes, t: float) -> None:
        code = int.from_bytes(data[:2], "little") if len(data) >= 2 else 0
        if code and not self.emergency:
            self.emergency = f"{self.who}: emergency {code:04X}h, {emergency_text(code)}"
