"""A US Digital QSB at the twin's load encoder: text commands, a counter of 32 bits, time stamps      [usdigital]

`R`, `W` or `S` + register (2 hex digits) + data (up to 8) + CR or LF; answers `r`, `w`, `s`, or `e` for an error, with
register, 8 digits, 8 digits of time stamp unless register 0D is 0, `!` and the end of line register 15 asks for.
"""

from __future__ import annotations

from typing import final

from sim.sensors import TwinLoadEncoder
from sim.wire.agenda import Agenda
from sim.wire.pty import LineDevice
from sim.world import World

BAUD = 230_400
KIND, MODE = 0x00, 0x03  # what is counted (0: quadrature, the only one there is here), MDR0 of the counter
THRESHOLD, INTERVAL, TIMESTAMP, ENCODER, VERSION, END, COMMAND = 0x0B, 0x0C, 0x0D, 0x0E, 0x14, 0x15, 0x16
QUARTERS = {0: 1, 1: 1, 2: 2, 3: 4}  # counts of a line by the lowest two bits of MDR0: none, ×1, ×2, ×4
DEFAULTS = {KIND: 0, MODE: 3, THRESHOLD: 0, INTERVAL: 0, TIMESTAMP: 1, VERSION: 1, END: 1, COMMAND: 0}
ENDS = {0: b"", 1: b"\n", 2: b"\r", 3: b"\r\n"}
TICK = 1.0 / 512.0  # s, of time stamp and interval
AT_ONCE = 1e-4  # s between readings that are sent as fast as they come
STORE = 3  # command: keep the registers without power
MODULUS = 1 << 32


@final
class Qsb(LineDevice):
    """The counter starts at zero with the power, and when DTR falls."""

    def __init__(self, agenda: Agenda, world: World) -> None:
        self.agenda, self.world = agenda, world
        self.sensor = TwinLoadEncoder(world)
        self.sensor.connect()
        self.registers = dict(DEFAULTS)
        self._stored = dict(DEFAULTS)
        self._life = 0

    def plugged(self) -> None:
        self.registers = dict(self._stored)
        self._start = self.agenda.now
        self._zero = self._quarters()
        self._command = b""
        self._life += 1

    def receive(self, data: bytes) -> None:
        *commands, self._command = (self._command + data).replace(b"\n", b"\r").split(b"\r")
        for command in commands:
            if command:
                self._perform(command.strip().upper())

    def _perform(self, command: bytes) -> None:
        try:
            verb, register = command[:1], int(command[1:3], 16)
            value = int(command[3:], 16) if command[3:] else 0
        except ValueError:
            self._answer(b"e", 0, 1)
            return
        known = register in self.registers or register == ENCODER
        match verb:
            case b"R" if known:
                self._life += 1  # reading ends a stream
                self._answer(b"r", register, self._value(register))
            case b"W" if register in self.registers and value < MODULUS:
                self._write(register, value)
                self._answer(b"w", register, value)
            case b"S" if register == ENCODER:
                self._life += 1
                self._stream(self._life, None)
            case _:
                self._answer(b"e", register, 2)

    def _write(self, register: int, value: int) -> None:
        if register == COMMAND and value == STORE:
            self._stored = dict(self.registers)
            return
        self.registers[register] = value
        if register == MODE:
            self._zero = self._quarters()

    def _stream(self, life: int, last: int | None) -> None:
        """Send the counter when it has moved by the threshold, looked at every interval; 0 sends it every time."""
        if life != self._life or not self.line.present:
            return
        now = self._value(ENCODER)
        if last is None or abs(now - last) >= self.registers[THRESHOLD]:
            self._answer(b"s", ENCODER, now)
            last = now
        self.agenda.after(max(self._answer_time(), self.registers[INTERVAL] * TICK), lambda: self._stream(life, last))

    def _answer_time(self) -> float:
        return max(AT_ONCE, len(self._text(b"s", ENCODER, 0)) * 10.0 / BAUD)

    def _quarters(self) -> int:
        self.world.advance_to(self.agenda.now)
        return self.sensor.read().counts * QUARTERS[self.registers[MODE] & 3] // 4

    def _value(self, register: int) -> int:
        return (self._quarters() - self._zero) % MODULUS if register == ENCODER else self.registers[register]

    def _text(self, kind: bytes, register: int, value: int) -> bytes:
        stamp = b""
        if self.registers[TIMESTAMP]:
            stamp = b"%08X" % (int((self.agenda.now - self._start) / TICK) % MODULUS)
        return kind + b"%02X%08X" % (register, value) + stamp + b"!" + ENDS[self.registers[END] & 3]

    def _answer(self, kind: bytes, register: int, value: int) -> None:
        self.line.send(self._text(kind, register, value))
