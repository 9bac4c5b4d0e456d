"""CiA 404 torque transducer over CANopen: 9130h with its unit and digits, or 6130h, latched on SYNC      [cia404]"""

from __future__ import annotations

import math
import struct
from typing import ClassVar

from drivers.mapping import Mapped
from drivers.node import Node
from drivers.on_sync import OnSync
from drivers.pdo import Inputs
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.clock import NEVER, is_never
from rig.core.devices import Identity, TorqueReading, TorqueSensor
from rig.core.errors import NotReady
from rig.core.sample import NAN

PROFILE = 404
NEWTON_METRE = 0x56  # notation index of N·m      [cia303-2]
WHOLE, REAL = Mapped(0x9130, 1, 32, "i"), Mapped(0x6130, 1, 32, "f")


def prefix_of(unit: int) -> float | None:
    """The factor to N·m a unit code (6131h) means, None when it is no torque: prefix, numerator, denominator, 0."""
    exponent, numerator = struct.unpack("<bB", bytes(((unit >> 24) & 0xFF, (unit >> 16) & 0xFF)))
    return 10.0**exponent if numerator == NEWTON_METRE and not unit & 0xFF00 else None


class Cia404(OnSync, TorqueSensor):
    """A transducer at `node` on `bus`. Without 6131h and 6132h its numbers would mean nothing: refused."""

    name = "torque_sensor"
    keys: ClassVar[tuple[str, ...]] = ("bus", "node", "direction", "unit_code")
    answers: ClassVar[tuple[int, ...]] = (4,)  # data bytes of its frame after a SYNC

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.bus = wiring.bus(place)
        self.node = Node(self.bus, place.need("node"), "torque sensor")
        self.remarks = self.node.remarks
        self.place = place
        self._direction = place.options.get("direction", 1)
        self._inputs = Inputs(self.node, place.period)
        self._scale = 1.0  # N·m per digit
        self._last = TorqueReading(NEVER, NAN)

    def connect(self) -> Identity:
        """Identify, read the unit, map the value on SYNC, start. Raises NotReady."""
        self.node.open()
        identity = self.node.identify(PROFILE)
        self.node.pause()
        unit = self.node.sdo.read_uint(0x6131, 1, default=0)
        prefix = 1.0 if unit == self.place.options.get("unit_code") else prefix_of(unit)
        if prefix is None:
            raise NotReady(
                f"{self.node.who} measures in a unit that is no torque (6131h = {unit:08X}h), expected N·m, 00560000h; "
                f"where its manual says that this is N·m: {self.place.where}.unit_code = 0x{unit:08X}"
            )
        whole = self.node.sdo.read(WHOLE.at, WHOLE.sub, b"") != b""
        if not whole and self.node.sdo.read(REAL.at, REAL.sub, b"") == b"":  # some take it into a PDO, and tell zeros
            raise NotReady(f"{self.node.who} tells its torque neither as 9130h:1 nor as 6130h:1")
        digits = self.node.sdo.read_uint(0x6132, 1) if whole else 0
        self._scale = prefix * 10.0**-digits
        self._inputs.arrange(((WHOLE if whole else REAL,),))
        self.node.produce_heartbeat()
        self.node.start()
        self.node.forget()
        self._inputs.first(0.5)
        return identity

    def read(self) -> TorqueReading:
        """The newest torque; never waits. At the end of its range it is flagged."""
        self.bus.drain()
        latched = self._inputs.take()
        self.trouble = self._inputs.wrong or self.node.trouble(self.bus.clock.now())
        if is_never(latched) or latched == self._last.t:
            return self._last
        tau = self._direction * self.place.torque(self._inputs.values[0] * self._scale)
        over = not math.isfinite(tau) or self.place.at_its_end(tau)
        self._last = TorqueReading(latched, tau, int(Flag.SATURATED_TAU) if over else 0)
        return self._last
