"""CiA 406 absolute or incremental encoder over CANopen: 6004h, latched on SYNC      [cia406]"""

from __future__ import annotations

import math
from typing import ClassVar

from drivers.node import Mapped, Node
from drivers.unwrap import Unwrapped
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.devices import AngleReading, Encoder, Identity
from rig.core.errors import NotReady
from rig.core.sample import NAN

PROFILE = 406
TURN = 2 * math.pi
NEVER = -1e9  # s, a latch time older than any
LATE = 50.0  # times the fastest motion between two frames: a step beyond is no motion
SCALING = 1 << 2  # of 6000h: 6001h and 6002h are in use
POSITION = (Mapped(0x6004, 0, 32),)


def decode_position(data: bytes) -> int:
    """6004h u32: it wraps at the total range 6002h, not at 2^32."""
    return int.from_bytes(data[:4], "little")


class Cia406(Encoder):
    """An encoder at `node` on `bus`; its resolution has to agree with the bench file's."""

    name = "load_encoder"
    answers: ClassVar[tuple[int, ...]] = (4,)  # data bytes of its frame after a SYNC

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.bus = wiring.bus(place)
        self.node = Node(self.bus, place.need("node"), "load encoder")
        self.place = place
        self._direction = place.options.get("direction", 1)
        self._step = TURN / place.counts_per_turn
        self._angle = Unwrapped(1 << 32, 1)
        self._last = AngleReading(NEVER, NAN, 0)

    @property
    def _identifier(self) -> int:
        return 0x180 + self.node.number

    def connect(self) -> Identity:
        """Identify, compare the scale, map 6004h on SYNC, start. Raises NotReady."""
        self.node.open()
        identity = self.node.identify(PROFILE)
        self.node.pause()
        per_turn, modulus = self._scale()
        if per_turn != self.place.counts_per_turn:
            raise NotReady(
                f"{self.node.who} counts {per_turn} per turn, load_encoder.counts_per_turn in the bench file is "
                f"{self.place.counts_per_turn}"
            )
        fastest = self.place.speed_limit * self.place.period / self._step
        self._angle = Unwrapped(modulus, max(int(LATE * fastest), 1))
        for unused in (0x1801, 0x1802, 0x1803):
            self.node.switch_off_pdo(unused)
        self.node.map_pdo(0x1800, self._identifier, 1, POSITION)
        self.node.produce_heartbeat()
        self.node.start()
        self.node.forget()
        self.bus.frames.pop(self._identifier, None)
        self.bus.sync()
        if not self.bus.wait(0.5, lambda: self._identifier in self.bus.frames):
            raise NotReady(f"{self.node.who} sent no PDO after a SYNC: is anything else mapped or filtered?")
        self.read()
        return identity

    def _scale(self) -> tuple[int, int]:
        """Counts per turn, and at how many the position wraps."""
        if self.node.read_uint(0x6000, default=0) & SCALING:
            return self.node.read_uint(0x6001), self.node.read_uint(0x6002)
        per_turn = self.node.read_uint(0x6501)
        return per_turn, per_turn * max(self.node.read_uint(0x6502, default=1), 1)

    def read(self) -> AngleReading:
        """The newest position; never waits. A jump is marked as a new epoch; `trouble` says what else is wrong."""
        self.bus.drain()
        self.trouble = self.node.trouble(self.bus.clock.now())
        frame = self.bus.frames.get(self._identifier)
        if frame is None or frame.latched == self._last.t:
            return self._last
        if len(frame.data) != 4:
            self.trouble = f"{self.node.who} sends PDOs of {len(frame.data)} bytes, expected 4: mapped anew?"
            return self._last
        self.node.answered(frame)
        flags = Flag.EPOCH if self._angle.step(decode_position(frame.data)) else 0
        counts = self._direction * (self._angle.counts or 0)
        self._last = AngleReading(frame.latched, counts * self._step, counts, int(flags))
        return self._last

    def close(self) -> None:
        """Off the bus."""
        self.bus.close()
