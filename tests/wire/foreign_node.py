"""A CANopen node written apart from the twin, from CiA 301's tables alone: python-can and struct, a thread, switches.

It answers expedited SDOs, obeys NMT, sends TPDOs by their types (254 and 255 after a change, and by the event timer),
beats, and walks CiA 402 states. Everything in which devices of other makers differ is a field of `Ways`.
"""

from __future__ import annotations

import struct
import threading
import time
from dataclasses import dataclass, field

import can

Address = tuple[int, int]
ABSENT, NO_SUCH_SUB, READ_ONLY, WRITE_ONLY = 0x06020000, 0x06090011, 0x06010002, 0x06010001
WRONG_VALUE, STATE = 0x06090030, 0x08000022
NO_RTR, OFF = 1 << 30, 1 << 31  # of a PDO's identifier
OPERATIONAL, PREOP, STOPPED = 5, 127, 4


@dataclass(frozen=True)
class Ways:
    """How this one differs from the book."""

    boot: float = 0.0  # s from power to the boot-up message; deaf until then
    fixed_map: bool = False  # 1600h…, 1A00h… can be read only
    fixed_type: bool = False  # 180xh:2 as well
    insists_on_no_rtr: bool = False  # refuses identifiers of PDOs whose bit 30 is 0
    shows_no_rtr: bool = False  # takes them, and reads back with bit 30 set
    map_when_off_only: bool = True  # entries are taken while sub 0 is 0 and the PDO is off
    timer_too: bool = False  # event timers go on beside SYNC
    heartbeat: bool = True  # has 1017h
    beats: bool = True  # and really does
    guarding_only: bool = False  # answers remote frames at 700h + node with a toggling state, no heartbeat
    missed: int = 0  # SYNCs it does not answer after it was started
    emergencies: tuple[int, ...] = ()  # codes sent when it becomes operational, one after the other
    mute: bool = False  # no SDO answers at all
    short_answers: bool = False  # SDO answers of 4 bytes
    write_only: frozenset[Address] = frozenset()
    mode_when_enabled: bool = False  # 6061h follows 6060h in OPERATION ENABLED only, 0 until then
    other_mode: int = 0  # 6061h shows this one, whatever 6060h holds
    aborts: int = ABSENT  # for what it has not


@dataclass
class Tpdo:
    """A transmit PDO as it leaves the factory."""

    identifier: int
    kind: int
    mapped: list[int]  # index << 16 | sub << 8 | bits
    timer: int = 0  # ms, 180xh:5


@dataclass
class ForeignNode:
    """Powers up when made; `close` ends its thread. `objects` are raw bytes, little endian, at most four."""

    channel: str
    node: int
    objects: dict[Address, bytes]
    ways: Ways = field(default_factory=Ways)
    tpdos: list[Tpdo] = field(default_factory=list)
    rpdos: list[Tpdo] = field(default_factory=list)

    def __post_init__(self) -> None:
        for base, pdos in ((0x1800, self.tpdos), (0x1400, self.rpdos)):
            for n, pdo in enumerate(pdos):
                self.objects |= {
                    (base + n, 1): struct.pack("<I", pdo.identifier),
                    (base + n, 2): bytes((pdo.kind,)),
                    (base + n, 5): struct.pack("<H", pdo.timer),
                    (base + n + 0x200, 0): bytes((len(pdo.mapped),)),
                }
                for k in range(4):
                    entry = pdo.mapped[k] if k < len(pdo.mapped) else 0
                    self.objects[base + n + 0x200, k + 1] = struct.pack("<I", entry)
        if self.ways.heartbeat:
            self.objects[0x1017, 0] = b"\0\0"
        self.state, self.toggle = 0, 0
        self.received: list[tuple[int, bytes]] = []  # NMT and RPDOs
        self._sent: dict[int, bytes] = {}
        self._due: dict[int, float] = {}
        self._beat = 0.0
        self._missed = 0
        self._bus = can.Bus(interface="virtual", channel=self.channel)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._live, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Power off."""
        self._over.set()
        self._thread.join(2.0)
        self._bus.shutdown()

    def number(self, index: int, sub: int = 0) -> int:
        """An object as an unsigned number."""
        return int.from_bytes(self.objects[index, sub], "little")

    # ---- life ----

    def _live(self) -> None:
        self._over.wait(self.ways.boot)
        while self._bus.recv(0.0) is not None:
            pass  # what came while it was deaf
        self.state = PREOP
        self._send(0x700 + self.node, b"\0")
        while not self._over.is_set():
            message = self._bus.recv(0.001)
            if message is not None:
                self._take(message)
            self._by_time(time.monotonic())

    def _by_time(self, now: float) -> None:
        period = self.number(0x1017) / 1000 if self.ways.heartbeat and self.ways.beats else 0.0
        if period and now - self._beat >= period:
            self._beat = now
            self._send(0x700 + self.node, bytes((self.state,)))
        for n in self._running():
            timer = int.from_bytes(self.objects.get((0x1800 + n, 5), b""), "little") / 1000
            kind = self.number(0x1800 + n, 2)
            if kind >= 254 or self.ways.timer_too:
                if timer and now >= self._due.get(n, 0.0):
                    self._due[n] = now + timer
                    self._tell(n)
                elif kind >= 254 and self._bytes(n) != self._sent.get(n):
                    self._tell(n)

    def _running(self) -> list[int]:
        return [n for n in range(len(self.tpdos)) if self.state == OPERATIONAL and not self.number(0x1800 + n, 1) & OFF]

    def _take(self, message: can.Message) -> None:
        identifier, data = message.arbitration_id, bytes(message.data)
        if message.is_remote_frame:
            if identifier == 0x700 + self.node and self.ways.guarding_only:
                self._send(identifier, bytes((self.toggle | self.state,)))
                self.toggle ^= 0x80
        elif identifier == 0 and data[1:] in (b"\0", bytes((self.node,))):
            self._command(data[0])
        elif identifier == 0x80 and self._missed < self.ways.missed:
            self._missed += self.state == OPERATIONAL
        elif identifier == 0x80:
            for n in self._running():
                if self.number(0x1800 + n, 2) == 1:
                    self._tell(n)
        elif identifier == 0x600 + self.node and not self.ways.mute:
            answer = self._sdo(data)
            self._send(0x580 + self.node, answer[:4] if self.ways.short_answers else answer)
        else:
            self._rpdo(identifier, data)

    def _command(self, command: int) -> None:
        self.received.append((0, bytes((command,))))
        before, self.state = self.state, {1: OPERATIONAL, 2: STOPPED, 128: PREOP}.get(command, self.state)
        if self.state == OPERATIONAL != before:
            self._sent.clear()
            for code in self.ways.emergencies:
                self._send(0x80 + self.node, struct.pack("<HB5x", code, 1 if code else 0))

    def _send(self, identifier: int, data: bytes) -> None:
        self._bus.send(can.Message(arbitration_id=identifier, is_extended_id=False, data=data))

    # ---- PDOs ----

    def _mapped(self, at: int) -> list[tuple[Address, int]]:
        entries = [self.number(at, k + 1) for k in range(self.number(at, 0))]
        return [((e >> 16, e >> 8 & 0xFF), e & 0xFF) for e in entries]

    def _bytes(self, n: int) -> bytes:
        return b"".join(self.objects[a].ljust(bits // 8, b"\0") for a, bits in self._mapped(0x1A00 + n))

    def _tell(self, n: int) -> None:
        self._sent[n] = self._bytes(n)
        self._send(self.number(0x1800 + n, 1) & 0x7FF, self._sent[n])

    def _rpdo(self, identifier: int, data: bytes) -> None:
        for n in range(len(self.rpdos)):
            at = self.number(0x1400 + n, 1)
            if self.state == OPERATIONAL and not at & OFF and at & 0x7FF == identifier:
                self.received.append((identifier, data))
                for address, bits in self._mapped(0x1600 + n):
                    self._store(address, data[: bits // 8])
                    data = data[bits // 8 :]

    # ---- objects ----

    def _sdo(self, data: bytes) -> bytes:
        command, address = data[0], (data[1] | data[2] << 8, data[3])
        if address not in self.objects:
            return self._abort(data, self.ways.aborts)
        if command == 0x40:
            if address in self.ways.write_only:
                return self._abort(data, WRITE_ONLY)
            value = self.objects[address]
            return bytes((0x43 | (4 - len(value)) << 2,)) + data[1:4] + value.ljust(4, b"\0")
        value = data[4 : 4 + len(self.objects[address])]
        if command & 0xE0 != 0x20 or (refused := self._refuses(address, value)):
            return self._abort(data, refused if command & 0xE0 == 0x20 else 0x05040001)
        self._store(address, value)
        return b"\x60" + data[1:4] + bytes(4)

    def _abort(self, data: bytes, code: int) -> bytes:
        return b"\x80" + data[1:4] + struct.pack("<I", code)

    def _refuses(self, address: Address, value: bytes) -> int:
        index, sub = address
        number = int.from_bytes(value, "little")
        mapping = index & 0xFF00 in (0x1600, 0x1A00)
        if (mapping and self.ways.fixed_map) or (index & 0xFF00 == 0x1800 and sub == 2 and self.ways.fixed_type):
            return READ_ONLY
        if mapping and self.ways.map_when_off_only and not self.number(index - 0x200, 1) & OFF:
            return STATE
        if mapping and sub and self.number(index, 0):
            return STATE
        pdo = index & 0xFF00 in (0x1400, 0x1800) and sub == 1
        if pdo and self.ways.insists_on_no_rtr and not number & NO_RTR:
            return WRONG_VALUE
        return READ_ONLY if index in (0x1000, 0x1018, 0x6041, 0x6061, 0x6502) else 0

    def _store(self, address: Address, value: bytes) -> None:
        if address[0] & 0xFF00 in (0x1400, 0x1800) and address[1] == 1 and self.ways.shows_no_rtr:
            value = struct.pack("<I", int.from_bytes(value, "little") | NO_RTR)
        self.objects[address] = value
        if address == (0x6060, 0) and not self.ways.mode_when_enabled:
            self.objects[0x6061, 0] = bytes((self.ways.other_mode,)) if self.ways.other_mode else value
        if address == (0x6040, 0):
            self._walk(int.from_bytes(value, "little"))

    def _walk(self, word: int) -> None:
        now = self.number(0x6041) & 0x6F
        follows = {(0x40, 0x06): 0x21, (0x21, 0x07): 0x23, (0x23, 0x0F): 0x27}
        self.objects[0x6041, 0] = struct.pack("<H", follows.get((now, word), now) if word & 0x02 else 0x40)
        if self.ways.mode_when_enabled:
            self.objects[0x6061, 0] = self.objects[0x6060, 0] if self.number(0x6041) == 0x27 else b"\0"
