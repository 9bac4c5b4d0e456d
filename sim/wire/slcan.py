"""A serial CAN adapter on a pty in Lawicel's text protocol: `t` + identifier + length + data + CR      [lawicel]"""

from __future__ import annotations

from typing import final

from sim.wire.bus import Bus
from sim.wire.frame import ERROR as ERROR_FLAG
from sim.wire.frame import EXTENDED, REMOTE, Frame
from sim.wire.pty import LineDevice

OK, ERROR = b"\r", b"\a"
RATES = {ord("0") + n: rate for n, rate in enumerate((10e3, 20e3, 50e3, 100e3, 125e3, 250e3, 500e3, 750e3, 1e6))}


@final
class SerialCan(LineDevice):
    """Deaf and dumb at a bit rate that is not the bus's, as a real one would be."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self.port = bus.attach("slcan", self._deliver)
        self._open = False
        self._rate = bus.bitrate
        self._text = b""

    def plugged(self) -> None:
        self._open, self._text, self._rate = False, b"", self._bus.bitrate

    def wants(self) -> bool:
        return self.port.has_room

    def receive(self, data: bytes) -> None:
        *commands, self._text = (self._text + data).split(b"\r")
        for command in commands:
            self.line.send(self._perform(command))

    def _perform(self, command: bytes) -> bytes:
        match command[:1]:
            case b"":
                return OK
            case b"O" | b"L":
                self._open = True
            case b"C":
                self._open = False
            case b"S" if command[1:2] and command[1] in RATES:
                self._rate = RATES[command[1]]
            case b"V":
                return b"V1013\r"
            case b"N":
                return b"Ntwin\r"
            case b"t" | b"T" | b"r" | b"R":
                return self._send(command)
            case b"Z" | b"M" | b"m" | b"s" | b"S" | b"F":
                return ERROR if command[:1] == b"S" else OK
            case _:
                return ERROR
        return OK

    def _send(self, command: bytes) -> bytes:
        kind, digits = command[:1], 8 if command[:1] in b"TR" else 3
        try:
            identifier = int(command[1 : 1 + digits], 16)
            size = int(command[1 + digits : 2 + digits])
            data = bytes.fromhex(command[2 + digits :].decode("ascii"))
        except ValueError:
            return ERROR
        remote = kind in b"rR"
        if not self._open or size > 8 or (len(data) != size and not remote):
            return ERROR
        if self._rate == self._bus.bitrate:
            flags = (EXTENDED if digits == 8 else 0) | (REMOTE if remote else 0)
            self.port.send(Frame(identifier | flags, bytes(size) if remote else data))
        return b"z\r" if digits == 3 else b"Z\r"

    def _deliver(self, frame: Frame, t: float) -> None:
        if self._open and self._rate == self._bus.bitrate and self.line.present:
            self.line.send(line_of(frame))


def line_of(frame: Frame) -> bytes:
    """A frame as the adapter says it."""
    remote = frame.identifier & REMOTE
    data = b"" if remote else frame.data.hex().upper().encode("ascii")
    number = frame.identifier & (ERROR_FLAG - 1)
    if frame.identifier & EXTENDED:
        return b"%s%08X%d%s\r" % (b"R" if remote else b"T", number, len(frame.data), data)
    return b"%s%03X%d%s\r" % (b"r" if remote else b"t", number, len(frame.data), data)
