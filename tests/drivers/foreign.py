"""CANopen devices nobody here has built, made of frames: fixed PDOs, missing objects, abort codes of their own."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

from sim.wire.bus import Bus
from sim.wire.frame import Frame

Address = tuple[int, int]  # index, sub-index


@dataclass
class Tpdo:
    """One transmit PDO that cannot be changed."""

    number: int  # from 0: 1800h + number
    identifier: int
    kind: int  # transmission type
    mapped: list[tuple[int, int, int]]  # index, sub, bits


@dataclass
class Peer:
    """Answers SDOs of up to 4 bytes, sends its PDOs, knows the CiA 402 walk; everything else it refuses."""

    bus: Bus
    node: int
    objects: dict[Address, bytes]
    tpdos: list[Tpdo] = field(default_factory=list)
    rpdos: list[Tpdo] = field(default_factory=list)
    writable: set[Address] = field(default_factory=set)
    absent: int = 0x06020000  # abort code for what is not there
    refuses: int = 0x06010002  # and for what cannot be written
    heartbeat: bool = True
    state: int = 5  # boots in operational, as some do

    def __post_init__(self) -> None:
        for base, pdos in ((0x1800, self.tpdos), (0x1400, self.rpdos)):
            for pdo in pdos:
                at = base + pdo.number
                self.objects[at, 1] = struct.pack("<I", pdo.identifier)
                self.objects[at, 2] = bytes((pdo.kind,))
                self.objects[at + 0x200, 0] = bytes((len(pdo.mapped),))
                for n, (index, sub, bits) in enumerate(pdo.mapped, 1):
                    self.objects[at + 0x200, n] = struct.pack("<I", index << 16 | sub << 8 | bits)
        if self.heartbeat:
            self.objects[0x1017, 0] = b"\0\0"
            self.writable.add((0x1017, 0))
        self.port = self.bus.attach(f"foreign {self.node}", self._receive)
        self.bus.agenda.after(0.01, self._tick)

    def _tick(self) -> None:
        """Every ms: PDOs that follow no SYNC; every 50 ms a heartbeat, once it is asked for."""
        if self.state == 5:
            for pdo in self.tpdos:
                if pdo.kind >= 254:
                    self._send_pdo(pdo)
        period = int.from_bytes(self.objects.get((0x1017, 0), b""), "little")
        if period and round(self.bus.agenda.now * 1000) % period == 0:
            self.port.send(Frame(0x700 + self.node, bytes((self.state,))))
        self.bus.agenda.after(0.001, self._tick)

    def _receive(self, frame: Frame, t: float) -> None:
        match frame.identifier:
            case 0x000 if len(frame.data) == 2 and frame.data[1] in (0, self.node):
                self.state = {1: 5, 2: 4, 128: 127}.get(frame.data[0], self.state)
            case 0x080 if self.state == 5:
                for pdo in self.tpdos:
                    if pdo.kind == 1:
                        self._send_pdo(pdo)
            case number if number == 0x600 + self.node:
                answer = Frame(0x580 + self.node, self._sdo(frame.data))
                self.bus.agenda.after(0.001, lambda: self.port.send(answer))
            case number:
                for pdo in self.rpdos:
                    if number == pdo.identifier and self.state == 5:
                        self._take_pdo(pdo, frame.data)

    def _send_pdo(self, pdo: Tpdo) -> None:
        parts = [self.objects[index, sub].ljust(bits // 8, b"\0")[: bits // 8] for index, sub, bits in pdo.mapped]
        self.port.send(Frame(pdo.identifier, b"".join(parts)))

    def _take_pdo(self, pdo: Tpdo, data: bytes) -> None:
        for index, sub, bits in pdo.mapped:
            part, data = data[: bits // 8], data[bits // 8 :]
            self._written((index, sub), part)

    def _sdo(self, data: bytes) -> bytes:
        command, index, sub = struct.unpack_from("<BHB", data)
        head = data[1:4]
        if command == 0x40:
            value = self.objects.get((index, sub))
            if value is None:
                return b"\x80" + head + struct.pack("<I", self.absent)
            return bytes((0x43 | (4 - len(value)) << 2,)) + head + value.ljust(4, b"\0")
        if command & 0xE0 == 0x20:
            if (index, sub) not in self.writable:
                code = self.refuses if (index, sub) in self.objects else self.absent
                return b"\x80" + head + struct.pack("<I", code)
            self._written((index, sub), data[4 : 4 + len(self.objects[index, sub])])
            return b"\x60" + head + bytes(4)
        return b"\x80" + head + struct.pack("<I", 0x05040001)

    def _written(self, where: Address, value: bytes) -> None:
        self.objects[where] = value
        if where == (0x6040, 0):
            self._walk(int.from_bytes(value, "little"))
        if where == (0x6060, 0):
            self.objects[0x6061, 0] = value

    def _walk(self, word: int) -> None:
        now = int.from_bytes(self.objects[0x6041, 0], "little") & 0x6F
        follows = {(0x40, 0x06): 0x21, (0x21, 0x07): 0x23, (0x23, 0x0F): 0x27}
        now = 0x40 if not word & 0x02 else follows.get((now, word), now)
        self.objects[0x6041, 0] = struct.pack("<H", now)
