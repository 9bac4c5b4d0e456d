"""US Digital QSB: a quadrature encoder counted by a USB adapter that streams its counter as text      [usdigital-qsb]

230 400 baud 8N1, RTS low and DTR high (its falling edge resets the counter). A command is a letter, a register and
data in hexadecimal; an answer repeats letter and register, in small letters, then eight digits and `!`.
"""

from __future__ import annotations

import re
import time
from typing import ClassVar

from drivers.lines import Lines
from drivers.port import Port
from drivers.unwrap import Unwrapped
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.clock import NEVER
from rig.core.devices import AngleReading, Encoder, Identity
from rig.core.errors import NotReady
from rig.core.sample import NAN
from rig.core.units import TURN

BAUD = 230_400
ANSWER = re.compile(rb"([rwsex])([0-9A-Fa-f]{2})([0-9A-Fa-f]{8})(?:\s*([0-9A-Fa-f]{8}))?\s*!?")
ERRORS = "ex"  # kinds of answers; the value is the error's number in the maker's document
LONGEST = 40  # bytes of an answer
PATIENCE = 1.0  # s for an answer
KIND, MODE, THRESHOLD, INTERVAL, ENCODER, VERSION = 0x00, 0x03, 0x0B, 0x0C, 0x0E, 0x14  # registers
X4 = 0x03  # of MODE: four counts a line


def decode_answer(line: bytes) -> tuple[str, int, int] | None:
    """Kind (r read, w written, s streamed, e x errors), register and value; None when the line is none."""
    found = ANSWER.fullmatch(line.strip())
    return (found[1].decode(), int(found[2], 16), int(found[3], 16)) if found else None


class Qsb(Encoder):
    """The counter is 32 bits wide and streamed whenever it changes."""

    name = "load_encoder"
    keys: ClassVar[tuple[str, ...]] = ("port", "baud", "direction", "delay")

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.place = place
        self.port = Port(place.need("port"), place.options.get("baud", BAUD), "load encoder", rts=False)
        self.garbled = 0  # lines that were no answer
        self._clock = wiring.clock
        self._direction = place.options.get("direction", 1)
        self._delay = place.options.get("delay", 0.0)
        self._step = TURN / place.counts_per_turn
        self._angle = Unwrapped.of(place, 1 << 32)
        self._lines = Lines(LONGEST)
        self._heard = NEVER
        self._last = AngleReading(NEVER, NAN, 0)

    def connect(self) -> Identity:
        """Quadrature times four, streaming at every change and every interval. Raises NotReady."""
        self.port.open()
        self.port.write(b"\r\n")  # ends whatever half a command stood in its buffer
        self._lines.feed(b"\r\n")  # an answer has a shape of its own: the first need not be thrown away
        version = self._ask(b"R%02X" % VERSION)
        self._ask(b"W%02X%08X" % (KIND, 0))  # 0: quadrature
        self._ask(b"W%02X%08X" % (MODE, X4))
        self._ask(b"W%02X%08X" % (THRESHOLD, 0))  # 0: also while nothing moves, or rest would look like silence
        self._ask(b"W%02X%08X" % (INTERVAL, 0))
        value = self._ask(b"R%02X" % ENCODER)
        self._take(value)
        self.port.write(b"S%02X\r\n" % ENCODER)
        return Identity("US Digital QSB", self.port.path, f"{version:08X}")

    def _ask(self, command: bytes) -> int:
        """Raises NotReady: it refuses, or does not answer. An error about another register is one of whatever half a
        command stood in its buffer, and only told where nothing follows."""
        kind, register = command[:1].lower().decode(), int(command[1:3], 16)
        self.port.write(command + b"\r\n")
        until, told = time.monotonic() + PATIENCE, ""
        while time.monotonic() < until:
            for line in self._lines.feed(self.port.read()):
                answer = decode_answer(line)
                if answer and answer[0] == kind and answer[1] == register:
                    return answer[2]
                if answer and answer[0] in ERRORS:
                    if answer[1] == register:
                        raise NotReady(f"{self.port.who} refuses {command.decode()} with error {answer[2]}")
                    told = f", but told of error {answer[2]} in register {answer[1]:02X}"
            time.sleep(0.001)
        raise NotReady(f"{self.port.who} did not answer {command.decode()} within {PATIENCE:g} s{told}; is it a QSB?")

    def read(self) -> AngleReading:
        """The newest count; never waits."""
        self.trouble = self.port.dead
        for line in self._lines.feed(self.port.read()):
            answer = decode_answer(line)
            if answer and answer[0] in "rs" and answer[1] == ENCODER:
                self._take(answer[2])
            else:
                self.garbled += 1
        return self._last

    def _take(self, raw: int) -> None:
        flags = Flag.EPOCH if self._angle.step(raw) else 0
        counts = self._direction * (self._angle.counts or 0)
        self._last = AngleReading(self._clock.now() - self._delay, counts * self._step, counts, int(flags))

    def clear(self) -> None:
        """Look anew; a port that is gone stays gone until it is connected again. Raises NotReady: it is silent."""
        before, until = self.read(), time.monotonic() + PATIENCE
        while not self.port.dead and self.read() is before:
            if time.monotonic() > until:
                raise NotReady(f"{self.port.who} has told no count for {PATIENCE:g} s")
            time.sleep(0.005)

    def close(self) -> None:
        """Stop the stream, let the port go."""
        self.port.write(b"R%02X\r\n" % ENCODER)
        self.port.close()
