"""A torque transducer after CiA 404 between the twin's gear and load: channel 1 of the analogue inputs."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import final

from rig.core.channels import Flag
from sim.sensors import TwinTorqueSensor
from sim.wire.bus import Bus
from sim.wire.node import Node, NodeIdentity
from sim.wire.objects import I16, I32, REAL32, U8, U16, U32, Abort, AbortCode, Entry, Kind, Objects
from sim.wire.pdo import PdoDefault
from sim.world import World

NEWTON_METRES = 0x00560000  # 6131: no prefix, newton metre      [cia303, 4.4 as others transcribed it]
DIGITS = 3  # 6132: integers in 10⁻³ of the unit
TARE, ZERO = 0x61726174, 0x6F72657A  # "tara", "zero" as U32
NOT_VALID, POSITIVE, NEGATIVE = 1 << 0, 1 << 1, 1 << 2  # 6150: invalid, overload
CHANNEL = 1


@final
class TorqueTransducer(Node):
    """Process value 6130 (real), 7130 and 9130 (integers, 6132 digits behind the point of unit 6131); net value 6140.

    6125 "zero" takes what is there now as zero, 6139 "tara" takes it away from the net value. Both are lost with the
    power unless stored with 1010.
    """

    profile_defaults = (
        {},
        {0: PdoDefault(0x180, 254, [0x91300120, 0x61500108]), 1: PdoDefault(0x280, 1, [0x91300120, 0x61500108])},
    )

    def __init__(self, bus: Bus, node_id: int, world: World) -> None:
        self.world = world
        self.sensor = TwinTorqueSensor(world)
        self.sensor.connect()
        self.broken = False  # the cable between sensor and amplifier is out
        super().__init__(bus, node_id, NodeIdentity(0x00020194, "hdrig twin torque transducer", 0x404, world.seed))

    def furnish(self, objects: Objects) -> None:
        """Objects of channel 1 for a new life of the node, as from the factory: N·m, three digits, no zero, no tare."""

        def channel(index: int, entry: Entry) -> Entry:
            """`entry` at sub-index CHANNEL of `index`."""
            objects.record(index, {CHANNEL: entry})
            return entry

        def value(index: int, kind: Kind, read: Callable[[], float]) -> None:
            """A read-only value that can be mapped into a PDO."""
            channel(index, Entry(kind, 0, "r", read=read, mappable=True))

        channel(0x6110, Entry(U16, 0x5A, "r"))  # sensor type: strain gauge bridge
        self.offset = channel(0x6124, Entry(REAL32, 0.0))
        channel(0x6125, Entry(U32, 0, "w", write=self._zero))
        self.unit = channel(0x6131, Entry(U32, NEWTON_METRES))
        self.digits = channel(0x6132, Entry(U8, DIGITS, write=self._set_digits))
        self.tare = channel(0x6138, Entry(REAL32, 0.0))
        channel(0x6139, Entry(U32, 0, "w", write=self._take_tare))
        value(0x6130, REAL32, self._process)
        value(0x7130, I16, lambda: self._digital(self._process(), 15))
        value(0x9130, I32, lambda: self._digital(self._process(), 31))
        value(0x6140, REAL32, self._net)
        value(0x7140, I16, lambda: self._digital(self._net(), 15))
        value(0x9140, I32, lambda: self._digital(self._net(), 31))
        value(0x6150, U8, self._status)

    def _tau(self) -> float:
        """N·m at the sensor; not a number when it is not connected."""
        self.world.advance_to(self.agenda.now)
        return math.nan if self.broken else self.sensor.read().tau

    def _process(self) -> float:
        """In the unit of 6131, whose highest byte is the power of ten."""
        exponent = (self.unit.number >> 24 ^ 0x80) - 0x80
        return float(self._tau() / 10.0**exponent - self.offset.value)  # type: ignore[operator]

    def _net(self) -> float:
        return float(self._process() - self.tare.value)  # type: ignore[operator]

    def _digital(self, value: float, bits: int) -> int:
        """`value` as an integer of 6132 digits, at the end of its range when it does not fit, or is none."""
        most = (1 << bits) - 1
        if math.isnan(value):
            return most
        return max(-most - 1, min(most, round(value * 10.0**self.digits.number)))

    def _status(self) -> int:
        if math.isnan(self._tau()):
            return NOT_VALID
        reading = self.sensor.read()
        if not reading.flags & Flag.SATURATED_TAU:
            return 0
        return NOT_VALID | (POSITIVE if reading.tau > 0.0 else NEGATIVE)

    def _zero(self, value: float) -> None:
        self._expect(value, ZERO)
        self.offset.value = float(self.offset.value) + self._process()

    def _take_tare(self, value: float) -> None:
        self._expect(value, TARE)
        self.tare.value = self._process()

    def _expect(self, value: float, signature: int) -> None:
        if value != signature or math.isnan(self._tau()):
            raise Abort(AbortCode.VALUE)

    def _set_digits(self, value: float) -> None:
        if value > 9:
            raise Abort(AbortCode.TOO_HIGH)
