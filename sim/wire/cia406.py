"""An absolute encoder after CiA 406 on the twin's load."""

from __future__ import annotations

import math
from typing import final

from sim.sensors import TwinLoadEncoder
from sim.wire.bus import Bus
from sim.wire.node import Node, NodeIdentity
from sim.wire.objects import I16, I32, U16, U32, Abort, AbortCode, Entry, Objects
from sim.wire.pdo import PdoDefault
from sim.wire.watch import State
from sim.world import World

BACKWARDS, SCALED = 1 << 0, 1 << 2  # 6000: code sequence counter-clockwise, scaling on
LARGEST = 1 << 32
REVOLUTIONS = 4096  # that the encoder tells apart, where its counts leave room for it
SPEED_OVER = 0.01  # s over which 6030 is taken


@final
class AbsoluteEncoder(Node):
    """6004 in measuring units, 0 to 6002 − 1, wrapping there. 6030 in units per 10 ms. Nothing is lost at power-off.

    Scaled (6000 bit 2): 6001 units per revolution, 6002 units in all. Not scaled: 6501 per revolution, all of them.
    """

    profile_defaults = (
        {},
        {0: PdoDefault(0x180, 254, [0x60040020]), 1: PdoDefault(0x280, 1, [0x60040020])},
    )

    def __init__(self, bus: Bus, node_id: int, world: World) -> None:
        self.world = world
        self.encoder = TwinLoadEncoder(world)
        self.encoder.connect()
        self.resolution = world.parameters.load_counts_per_turn
        self.revolutions = min(REVOLUTIONS, LARGEST // self.resolution)
        self.offset = 0.0  # counts of the disc; set by 6003, kept without power
        self._pace = 0  # counts in the last SPEED_OVER
        super().__init__(bus, node_id, NodeIdentity(0x00020196, "hdrig twin load encoder", 0x406, world.seed))
        self._measure_speed(self._counts())

    def furnish(self, objects: Objects) -> None:
        """Objects of the profile for a new life of the node, as from the factory; the preset alone is kept."""
        o = objects
        total = self.resolution * self.revolutions
        self.operating = o.add(0x6000, Entry(U16, SCALED))
        self.units = o.add(0x6001, Entry(U32, self.resolution, write=self._set_units))
        self.range = o.add(0x6002, Entry(U32, total, write=self._set_range))
        o.add(0x6003, Entry(U32, 0, write=self._preset))
        o.add(0x6004, Entry(U32, 0, "r", read=self.position, mappable=True))
        o.record(0x6030, {1: Entry(I16, 0, "r", read=self._speed, mappable=True)})
        self.cyclic = o.add(0x6200, Entry(U16, 0, write=self._set_cyclic))
        o.add(0x6500, Entry(U16, 0, "r", read=lambda: self.operating.number))
        o.add(0x6501, Entry(U32, self.resolution, "r"))
        o.add(0x6502, Entry(U16, self.revolutions, "r"))
        self.alarms = o.add(0x6503, Entry(U16, 0, "r", mappable=True))
        o.add(0x6504, Entry(U16, 1, "r"))  # alarm supported: position error
        self.warnings = o.add(0x6505, Entry(U16, 0, "r", mappable=True))
        o.add(0x6506, Entry(U16, 0, "r"))
        o.add(0x6507, Entry(U32, 0x03020406, "r"))  # profile and software version, 3.2 and 4.6
        o.add(0x6508, Entry(U32, 0xFFFFFFFF, "r"))  # operating time, not counted
        o.add(0x6509, Entry(I32, 0, "r", read=self._offset_units))
        o.record(0x650A, {1: Entry(I32, 0, "r"), 2: Entry(I32, 0, "r"), 3: Entry(I32, -1, "r")})
        o.add(0x650B, Entry(U32, self.world.seed, "r"))

    def _counts(self) -> int:
        """Of the disc now, in the sense 6000 asks for."""
        self.world.advance_to(self.agenda.now)
        counts = self.encoder.read().counts
        return -counts if self.operating.number & BACKWARDS else counts

    @property
    def _scale(self) -> float:
        return self.units.number / self.resolution if self.operating.number & SCALED else 1.0

    @property
    def _modulus(self) -> int:
        scaled = self.operating.number & SCALED
        return self.range.number if scaled else self.resolution * self.revolutions

    def position(self) -> int:
        """6004 now."""
        return math.floor((self._counts() + self.offset) * self._scale) % self._modulus

    def _measure_speed(self, past: int) -> None:
        counts = self._counts()
        self._pace = counts - past
        if self.port in self.bus.ports:
            self.agenda.after(SPEED_OVER, lambda: self._measure_speed(counts))

    def _speed(self) -> int:
        """Units per 10 ms, clipped to 16 bits."""
        return max(-0x8000, min(0x7FFF, round(self._pace * self._scale)))

    def _preset(self, value: float) -> None:
        if not 0 <= value < self._modulus:
            raise Abort(AbortCode.TOO_HIGH)
        self.offset = value / self._scale - self._counts()

    def _offset_units(self) -> int:
        units = math.floor(self.offset * self._scale)
        return (units + LARGEST // 2) % LARGEST - LARGEST // 2

    def _set_units(self, value: float) -> None:
        if not 0 < value <= self.resolution:
            raise Abort(AbortCode.TOO_HIGH if value else AbortCode.TOO_LOW)

    def _set_range(self, value: float) -> None:
        if not 0 < value <= self.resolution * self.revolutions:
            raise Abort(AbortCode.TOO_HIGH if value else AbortCode.TOO_LOW)

    def _set_cyclic(self, value: float) -> None:
        """The cyclic timer is the event timer of the first TPDO."""
        self.objects.find(0x1800, 5).accept(U16.pack(value))
        if self.state is State.OPERATIONAL:
            self.tpdos[0].begin()
