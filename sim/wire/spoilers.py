"""What can be wrong with a serial line."""

from __future__ import annotations

import math
from typing import final

from sim.wire.pty import Spoiler

Parts = list[tuple[float, bytes]]


@final
class Torn(Spoiler):
    """Every message in two pieces, the second `seconds` later."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds

    def spoil(self, data: bytes) -> Parts:
        middle = len(data) // 2
        return [(0.0, data[:middle]), (self.seconds, data[middle:])]


@final
class Glued(Spoiler):
    """The end of line of every second message is lost: two lines are one."""

    def __init__(self) -> None:
        self._turn = False

    def spoil(self, data: bytes) -> Parts:
        self._turn = not self._turn
        return [(0.0, data.rstrip(b"\r\n") if self._turn else data)]


@final
class Cut(Spoiler):
    """The last `size` bytes before the end of line of `count` messages are lost: 12.345 becomes 12.3."""

    def __init__(self, size: int, count: float = math.inf) -> None:
        self.size, self.count = size, count

    @property
    def sound(self) -> bool:
        return self.count <= 0

    def spoil(self, data: bytes) -> Parts:
        if self.count <= 0:
            return [(0.0, data)]
        self.count -= 1
        body = data.rstrip(b"\r\n")
        return [(0.0, body[: max(0, len(body) - self.size)] + data[len(body) :])]


@final
class Garbage(Spoiler):
    """`size` bytes that mean nothing before every message."""

    def __init__(self, size: int) -> None:
        self.size = size

    def spoil(self, data: bytes) -> Parts:
        return [(0.0, bytes((0xFF - 7 * n) & 0xFF for n in range(self.size)) + data)]


@final
class Mute(Spoiler):
    """Nothing arrives."""

    def spoil(self, data: bytes) -> Parts:
        return []
