"""A torque sensor that sends a line of text per reading, such as `-12.345 Nm`, with or without a checksum `*5A`.

No maker's protocol in particular: the shape several amplifiers share. The unit has to be there, and has to be N·m; a
checksum, two hexadecimal digits behind `*`, is the exclusive or of all bytes before it, and is believed over the text.
"""

from __future__ import annotations

import math
import re
import time
from functools import reduce
from typing import ClassVar

from drivers.lines import Lines
from drivers.port import Port
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.clock import NEVER, is_never
from rig.core.devices import Identity, TorqueReading, TorqueSensor
from rig.core.errors import NotReady
from rig.core.sample import NAN

LINE = re.compile(rb"\s*([+-]?\d{1,6}(?:\.\d{1,9})?)\s*N(?:[ .*-]|\xb7|\xc2\xb7)?m\s*(?:\*([0-9A-Fa-f]{2}))?\s*")
LONGEST = 48  # bytes of a line
PATIENCE = 1.0  # s for the first good line
EXAMPLE = "for example '-12.345 Nm'"


def decode_line(line: bytes) -> float | None:
    """N·m, or None when the line says no torque, or its checksum something else."""
    found = LINE.fullmatch(line)
    if found is None:
        return None
    if found[2] is not None and reduce(lambda a, b: a ^ b, line[: line.rindex(b"*")], 0) != int(found[2], 16):
        return None
    return float(found[1])


class AsciiTorque(TorqueSensor):
    """Read without waiting; its readings are as old as `delay` says when they arrive."""

    name = "torque_sensor"
    keys: ClassVar[tuple[str, ...]] = ("port", "baud", "direction", "delay")

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.place = place
        self.port = Port(place.need("port"), place.need("baud"), "torque sensor")
        self.garbled = 0  # lines that said no torque
        self._useless = 0  # bytes since the last line that said one
        self._clock = wiring.clock
        self._direction = place.options.get("direction", 1)
        self._delay = place.options.get("delay", 0.0)
        self._lines = Lines(LONGEST)
        self._last = TorqueReading(NEVER, NAN)

    def connect(self) -> Identity:
        """Open the port and wait for a line that makes sense. Raises NotReady."""
        self.port.open()
        until = time.monotonic() + PATIENCE
        while is_never(self.read().t):
            if time.monotonic() > until:
                raise NotReady(f"{self.port.who} sent {self._useless_words()} in {PATIENCE:g} s, expected {EXAMPLE}")
            time.sleep(0.005)
        return Identity("ASCII torque sensor", self.port.path)

    def _useless_words(self) -> str:
        if not self._useless:
            return "nothing"
        lines = f"{self.garbled} lines that say no torque" if self.garbled else "not one line"
        return f"{self._useless} bytes, {lines} (is baud = {self.port.baud} right, is its unit N·m?)"

    def read(self) -> TorqueReading:
        """The newest line; never waits."""
        data = self.port.read()
        self.trouble = self.port.dead
        if not data:
            return self._last
        self._useless += len(data)
        for line in reversed(self._lines.feed(data)):
            tau = decode_line(line)
            if tau is not None:
                self._useless = 0
                tau = self.place.torque(tau)
                over = not math.isfinite(tau) or self.place.at_its_end(tau)
                t = self._clock.now() - self._delay
                self._last = TorqueReading(t, self._direction * tau, int(Flag.SATURATED_TAU) if over else 0)
                break
            self.garbled += 1
        return self._last

    @property
    def silent(self) -> str:
        """That bytes come which say nothing: another unit, another baud rate, a disturbed line."""
        told = f"{self.port.who} sent {self._useless} bytes meanwhile, and no line that says a torque"
        return told if self._useless > LONGEST else ""

    def clear(self) -> None:
        """Look anew; a port that is gone stays gone until it is connected again. Raises NotReady: it is silent."""
        before, until = self.read(), time.monotonic() + PATIENCE
        while not self.port.dead and self.read() is before:
            if time.monotonic() > until:
                raise NotReady(f"{self.port.who} has told no torque for {PATIENCE:g} s")
            time.sleep(0.005)

    def close(self) -> None:
        """Let the port go."""
        self.port.close()
