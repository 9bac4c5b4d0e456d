"""A host on the twin's bus in virtual time. What it sends is written by hand, what it hears is kept as it came."""

from __future__ import annotations

import struct
from functools import cache

from rig.bench import read, twin_parameters
from sim.parameters import TwinParameters
from sim.wire.assembly import Assembly
from sim.wire.frame import REMOTE, Frame
from sim.wire.motor import Rating

BOOTED = 0.1  # s
ANSWERED = 0.003  # s, an SDO answer has come


@cache
def parameters(*overrides: str) -> TwinParameters:
    """Of the bench 'twin' with some numbers changed."""
    found: TwinParameters = twin_parameters(read("twin", overrides).file)
    return found


def assembly(*overrides: str, bitrate: float = 1e6) -> Assembly:
    """The twin of the bench 'twin': 10 000 counts a turn, 3 N·m rated, gear 50, 900 000 counts a turn of the load."""
    return Assembly(parameters(*overrides), 1, Rating(3.0, 0.5), bitrate)


class Host:
    """One station, driven step by step."""

    def __init__(self, twin: Assembly) -> None:
        self.twin = twin
        self.port = twin.bus.attach("host 1", self._hear)
        self.heard: list[tuple[float, int, str]] = []

    def _hear(self, frame: Frame, t: float) -> None:
        self.heard.append((t, frame.identifier, frame.data.hex(" ")))

    def wait(self, seconds: float) -> None:
        """Let time pass."""
        self.twin.agenda.run_until(self.twin.agenda.now + seconds)

    def send(self, identifier: int, data: str = "") -> None:
        """A frame; `data` in hexadecimal."""
        self.port.send(Frame(identifier, bytes.fromhex(data)))

    def guards(self, identifier: int) -> None:
        """A remote frame for one byte."""
        self.port.send(Frame(identifier | REMOTE, bytes(1)))

    def hears(self, identifier: int, seconds: float) -> list[str]:
        """The data of all frames with that identifier in the next `seconds`."""
        self.heard.clear()
        self.wait(seconds)
        return [data for _, number, data in self.heard if number == identifier]

    def asks(self, node: int, request: str) -> str:
        """An SDO request and its answer, both as hexadecimal; "" when there is none."""
        self.send(0x600 + node, request)
        answers = self.hears(0x580 + node, ANSWERED)
        assert len(answers) <= 1, answers
        return answers[0] if answers else ""

    def put(self, node: int, index: int, sub: int, kind: str, value: float) -> str:
        """Expedited download; "" when it was taken, else the abort code as the wire has it."""
        data = struct.pack("<" + kind, value)
        head = struct.pack("<BHB", 0x23 | (4 - len(data)) << 2, index, sub)
        answer = self.asks(node, (head + data.ljust(4, b"\0")).hex())
        return "" if answer.startswith("60") else answer[12:]

    def get(self, node: int, index: int, sub: int, kind: str) -> float:
        """Expedited upload."""
        answer = bytes.fromhex(self.asks(node, struct.pack("<BHB4x", 0x40, index, sub).hex()))
        assert answer[0] & 0xE0 == 0x40, answer.hex()
        value: float = struct.unpack_from("<" + kind, answer, 4)[0]
        return value

    def start(self, node: int = 0) -> None:
        """NMT start; 0 is everybody."""
        self.send(0x000, f"01{node:02x}")
        self.wait(0.001)

    def enable(self, mode: int) -> None:
        """The drive, by SDO, up to operation enabled."""
        self.start(1)
        assert self.put(1, 0x6060, 0, "b", mode) == ""
        for word in (0x06, 0x07, 0x0F):
            assert self.put(1, 0x6040, 0, "H", word) == ""


def host(*overrides: str, bitrate: float = 1e6) -> Host:
    """A host at a twin whose nodes have booted."""
    made = Host(assembly(*overrides, bitrate=bitrate))
    made.wait(BOOTED)
    return made
