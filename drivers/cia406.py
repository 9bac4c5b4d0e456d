"""CiA 406 absolute or incremental encoder over CANopen: 6004h, latched on SYNC      [cia406]"""

from __future__ import annotations

from typing import ClassVar

from drivers.mapping import Mapped
from drivers.node import Node
from drivers.on_sync import OnSync
from drivers.pdo import Inputs
from drivers.unwrap import Unwrapped
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.clock import NEVER, is_never
from rig.core.devices import AngleReading, Encoder, Identity
from rig.core.errors import NotReady
from rig.core.sample import NAN
from rig.core.units import TURN

PROFILE = 406
SCALING = 1 << 2  # of 6000h: 6001h and 6002h are in use
WHOLE = 1 << 32  # values of 6004h: a total range of so many does not fit into 6002h, which is then 0
POSITION = (Mapped(0x6004, 0, 32, "I"),)  # it wraps at the total range 6002h, not at 2^32


class Cia406(OnSync, Encoder):
    """An encoder at `node` on `bus`; its resolution has to agree with the bench file's."""

    name = "load_encoder"
    keys: ClassVar[tuple[str, ...]] = ("bus", "node", "direction")
    answers: ClassVar[tuple[int, ...]] = (4,)  # data bytes of its frame after a SYNC

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.bus = wiring.bus(place)
        self.node = Node(self.bus, place.need("node"), "load encoder")
        self.remarks = self.node.remarks
        self.place = place
        self._inputs = Inputs(self.node, place.period)
        self._direction = place.options.get("direction", 1)
        self._step = TURN / place.counts_per_turn
        self._angle = Unwrapped(WHOLE, 1)
        self._last = AngleReading(NEVER, NAN, 0)

    def connect(self) -> Identity:
        """Identify, compare the scale, map 6004h on SYNC, start. Raises NotReady."""
        self.node.open()
        identity = self.node.identify(PROFILE)
        if self.node.sdo.lacks(0x6004):
            raise NotReady(f"{self.node.who} does not tell its position (6004h)")
        self.node.pause()
        per_turn, modulus = self._scale()
        if per_turn != self.place.counts_per_turn:
            raise NotReady(
                f"{self.node.who} counts {per_turn} per turn, load_encoder.counts_per_turn in the bench file is "
                f"{self.place.counts_per_turn}"
            )
        self._angle = Unwrapped.of(self.place, modulus)
        self._inputs.arrange((POSITION,))
        self.node.produce_heartbeat()
        self.node.start()
        self.node.forget()
        self._inputs.first(0.5)
        self.read()
        return identity

    def _scale(self) -> tuple[int, int]:
        """Counts per turn, and at how many the position wraps."""
        if self.node.sdo.read_uint(0x6000, default=0) & SCALING:
            return self.node.sdo.read_uint(0x6001), self.node.sdo.read_uint(0x6002, default=0) or WHOLE
        per_turn = self.node.sdo.read_uint(0x6501)
        return per_turn, per_turn * max(self.node.sdo.read_uint(0x6502, default=1), 1)

    def read(self) -> AngleReading:
        """The newest position; never waits. A jump is marked as a new epoch; `trouble` says what else is wrong."""
        self.bus.drain()
        latched = self._inputs.take()
        self.trouble = self._inputs.wrong or self.node.trouble(self.bus.clock.now())
        if is_never(latched) or latched == self._last.t:
            return self._last
        flags = Flag.EPOCH if self._angle.step(int(self._inputs.values[0])) else 0
        counts = self._direction * (self._angle.counts or 0)
        self._last = AngleReading(latched, counts * self._step, counts, int(flags))
        return self._last
