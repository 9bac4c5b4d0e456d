"""What can be wrong with the bus itself: frames lost, late, doubled, out of order, shortened, noise."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import final

from sim.wire.bus import Tamper
from sim.wire.frame import Frame

Arrivals = Sequence[tuple[float, Frame]]


class Selective(Tamper, ABC):
    """Acts on `count` frames with `identifier` (flags included; None: every frame), then it is done."""

    def __init__(self, identifier: int | None, count: float = math.inf) -> None:
        self.identifier, self.count = identifier, count

    def pass_on(self, frame: Frame) -> Arrivals:
        if self.done or self.identifier not in (None, frame.identifier):
            return ((0.0, frame),)
        self.count -= 1
        self.done = self.count <= 0
        return self.act(frame)

    def __str__(self) -> str:
        which = "" if self.identifier is None else f" identifier=0x{self.identifier:x}"
        left = f" count={self.count:g}" if math.isfinite(self.count) else ""
        return f"{type(self).__name__.lower()}{which}{left}"

    @abstractmethod
    def act(self, frame: Frame) -> Arrivals:
        """What arrives in place of one it acts on."""


@final
class Drop(Selective):
    """Lost for everybody."""

    def act(self, frame: Frame) -> Arrivals:
        return ()


@final
class Delay(Selective):
    """`seconds` late."""

    def __init__(self, identifier: int | None, seconds: float, count: float = math.inf) -> None:
        super().__init__(identifier, count)
        self.seconds = seconds

    def act(self, frame: Frame) -> Arrivals:
        return ((self.seconds, frame),)


@final
class Duplicate(Selective):
    """Twice, as after an error that only some receivers saw."""

    def act(self, frame: Frame) -> Arrivals:
        return (0.0, frame), (0.0, frame)


@final
class Reorder(Selective):
    """Each second one of them arrives before the first."""

    def __init__(self, identifier: int | None, count: float = math.inf) -> None:
        super().__init__(identifier, count)
        self._held: Frame | None = None

    def act(self, frame: Frame) -> Arrivals:
        if self._held is None:
            self._held = frame
            return ()
        held, self._held = self._held, None
        return (0.0, frame), (0.0, held)


@final
class Resize(Selective):
    """`size` data bytes instead of those it has: cut off, or filled up with zeros."""

    def __init__(self, identifier: int | None, size: int, count: float = math.inf) -> None:
        super().__init__(identifier, count)
        self.size = size

    def act(self, frame: Frame) -> Arrivals:
        return ((0.0, Frame(frame.identifier, frame.data[: self.size].ljust(self.size, b"\0"))),)
