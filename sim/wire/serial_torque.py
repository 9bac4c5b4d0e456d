"""An ASCII torque sensor on a serial line: a line per reading, `-12.345 Nm` CR LF, of its own accord and on `?` CR.

No maker's protocol in particular: the shape that several amplifiers share.
"""

from __future__ import annotations

from typing import final

from sim.sensors import TwinTorqueSensor
from sim.wire.agenda import Agenda
from sim.wire.pty import LineDevice
from sim.world import World

BAUD = 115_200


@final
class AsciiTorque(LineDevice):
    """`rate` lines a second; 0: only on request. `Z` CR takes what is there now as zero until it loses power."""

    def __init__(self, agenda: Agenda, world: World, rate: float) -> None:
        self.agenda, self.world, self.rate = agenda, world, rate
        self.sensor = TwinTorqueSensor(world)
        self.sensor.connect()
        self._zero = 0.0  # N·m
        self._command = b""
        self._life = 0

    def plugged(self) -> None:
        self._zero, self._command = 0.0, b""
        self._life += 1
        if self.rate > 0.0:
            self._stream(self._life)

    def _stream(self, life: int) -> None:
        if life == self._life and self.line.present:
            self.say()
            self.agenda.after(1.0 / self.rate, lambda: self._stream(life))

    def tau(self) -> float:
        """N·m now, as shown."""
        self.world.advance_to(self.agenda.now)
        return self.sensor.read().tau - self._zero

    def say(self) -> None:
        """Send a line."""
        self.line.send(f"{self.tau():.3f} Nm\r\n".encode("ascii"))

    def receive(self, data: bytes) -> None:
        *commands, self._command = (self._command + data).replace(b"\n", b"\r").split(b"\r")
        for command in commands:
            match command.strip():
                case b"?":
                    self.say()
                case b"Z":
                    self._zero += self.tau()
