"""CiA 404 torque transducer over CANopen: 9130h with its unit and digits, or 6130h, latched on SYNC      [cia404]"""

from __future__ import annotations

import math
import struct
from typing import ClassVar

from drivers.node import Mapped, Node
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.devices import Identity, TorqueReading, TorqueSensor
from rig.core.errors import NotReady
from rig.core.sample import NAN

PROFILE = 404
NEVER = -1e9  # s, a latch time older than any
NEWTON_METRE = 0x56  # notation index of N·m      [cia303-2]
WHOLE, REAL = Mapped(0x9130, 1, 32), Mapped(0x6130, 1, 32)


def prefix_of(unit: int) -> float | None:
    """The factor to N·m a unit code (6131h) means, None when it is no torque: prefix, numerator, denominator, 0."""
    exponent, numerator = struct.unpack("<bB", bytes(((unit >> 24) & 0xFF, (unit >> 16) & 0xFF)))
    return 10.0**exponent if numerator == NEWTON_METRE and not unit & 0xFF00 else None


class Cia404(TorqueSensor):
    """A transducer at `node` on `bus`. Without 6131h and 6132h its numbers would mean nothing: refused."""

    name = "torque_sensor"
    answers: ClassVar[tuple[int, ...]] = (4,)  # data bytes of its frame after a SYNC

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.bus = wiring.bus(place)
        self.node = Node(self.bus, place.need("node"), "torque sensor")
        self.place = place
        self._direction = place.options.get("direction", 1)
        self._whole = True
        self._scale = 1.0  # N·m per digit
        self._last = TorqueReading(NEVER, NAN)

    @property
    def _identifier(self) -> int:
        return 0x180 + self.node.number

    def connect(self) -> Identity:
        """Identify, read the unit, map the value on SYNC, start. Raises NotReady."""
        self.node.open()
        identity = self.node.identify(PROFILE)
        self.node.pause()
        unit = self.node.read_uint(0x6131, 1, default=0)
        prefix = prefix_of(unit)
        if prefix is None:
            raise NotReady(f"{self.node.who} measures in a unit that is no torque (6131h = {unit:08X}h), expected N·m")
        self._whole = self.node.read(0x9130, 1, b"") != b""
        digits = self.node.read_uint(0x6132, 1) if self._whole else 0
        self._scale = prefix * 10.0**-digits
        for unused in (0x1801, 0x1802, 0x1803):
            self.node.switch_off_pdo(unused)
        self.node.map_pdo(0x1800, self._identifier, 1, (WHOLE if self._whole else REAL,))
        self.node.produce_heartbeat()
        self.node.start()
        self.node.forget()
        self.bus.frames.pop(self._identifier, None)
        self.bus.sync()
        if not self.bus.wait(0.5, lambda: self._identifier in self.bus.frames):
            raise NotReady(f"{self.node.who} sent no PDO after a SYNC: is anything else mapped or filtered?")
        return identity

    def read(self) -> TorqueReading:
        """The newest torque; never waits. At the end of its range it is flagged."""
        self.bus.drain()
        self.trouble = self.node.trouble(self.bus.clock.now())
        frame = self.bus.frames.get(self._identifier)
        if frame is None or frame.latched == self._last.t:
            return self._last
        if len(frame.data) != 4:
            self.trouble = f"{self.node.who} sends PDOs of {len(frame.data)} bytes, expected 4: mapped anew?"
            return self._last
        self.node.answered(frame)
        raw = struct.unpack("<i" if self._whole else "<f", frame.data[:4])[0]
        tau = self._direction * raw * self._scale
        over = not math.isfinite(tau) or abs(tau) >= 0.999 * self.place.range
        self._last = TorqueReading(frame.latched, tau, int(Flag.SATURATED_TAU) if over else 0)
        return self._last

    def close(self) -> None:
        """Off the bus."""
        self.bus.close()
