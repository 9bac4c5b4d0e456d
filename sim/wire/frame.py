"""A classical CAN frame, and how many bits it is on the wire."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sim.wire.bits import wire_bits

EXTENDED, REMOTE, ERROR = 1 << 31, 1 << 30, 1 << 29  # flags in the identifier, as in linux/can.h
BASE = 0x7FF
INTERMISSION = 3  # bits between frames
TAIL = 10  # bits never stuffed: CRC delimiter, acknowledge slot and delimiter, end of frame


class Frame(NamedTuple):
    """Identifier with its flags, data. A remote frame asks for as many bytes as `data` has."""

    identifier: int
    data: bytes = b""

    @property
    def rank(self) -> tuple[int, int]:
        """Who wins the bus: the lower one. 29-bit frames lose against 11-bit ones of the same first 11 bits."""
        number = self.identifier & (ERROR - 1)
        remote = 1 if self.identifier & REMOTE else 0
        if self.identifier & EXTENDED:
            return number >> 18, (1 << 20) + (number << 1) + remote
        return number & BASE, remote

    @property
    def bits(self) -> int:
        """Bits on the wire with stuffing and the intermission after it: 111 to 135 for 8 bytes and 11 bits."""
        extended = 1 if self.identifier & EXTENDED else 0
        remote = 1 if self.identifier & REMOTE else 0
        data = np.frombuffer(self.data, np.uint8)
        return int(wire_bits(self.identifier & (ERROR - 1), extended, remote, data)) + TAIL + INTERMISSION
