"""Which PDOs of a node carry the objects we need: our own mapping where it can be set, the node's where it cannot.

A node that refuses to be mapped, as small drives and sensors do, may well send all we need: its mapping is read and its
frames are decoded by that. Numbers are unpacked by one precompiled format per PDO      [cia301, 7.5.2.35-38]
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterator, Sequence
from operator import attrgetter
from typing import NamedTuple

from drivers.bus import Frame
from drivers.mapping import EVENTS, EXTENDED, INVALID, Mapped, keep_sending, map_pdo, switch_off_pdo
from drivers.node import Node
from drivers.sdo import Refused
from drivers.silence import missing
from rig.core.clock import NEVER
from rig.core.errors import NotReady

MOST = 8  # PDOs looked at each way
EACH_SYNC, AFTER_CHANGE = 1, 0  # transmission types
AT_ONCE = 255  # of an RPDO: taken when it comes
AGAIN = 0.1  # s without a first reading until the next SYNC asks for it
LATCHED: Callable[[Frame], float] = attrgetter("latched")
ARRIVED: Callable[[Frame], float] = attrgetter("arrived")


class Layout(NamedTuple):
    """One PDO: its identifier, the format of its bytes, which of our objects its numbers are, what its time is."""

    identifier: int
    packing: struct.Struct
    slots: tuple[int, ...]
    time: Callable[[Frame], float] = LATCHED


def layout(identifier: int, mapped: Sequence[Mapped], wanted: Sequence[Mapped]) -> Layout | None:
    """None when none of `wanted` is in it, or when numbers in it do not fill bytes."""
    places = {(o.at, o.sub, o.bits): n for n, o in enumerate(wanted)}
    form, slots = "<", []
    for o in mapped:
        slot = places.get((o.at, o.sub, o.bits))
        if o.bits % 8:
            return None
        form += f"{o.bits // 8}x" if slot is None else wanted[slot].form
        if slot is not None:
            slots.append(slot)
    return Layout(identifier, struct.Struct(form), tuple(slots)) if slots else None


def present(node: Node, first: int) -> Iterator[tuple[int, int, int, list[Mapped]]]:
    """(communication object, identifier, transmission type, mapped objects) of the node's PDOs that are switched on."""
    for communication in range(first, first + MOST):
        identifier = node.sdo.read_uint(communication, 1, default=INVALID)
        if identifier & (INVALID | EXTENDED):
            continue
        count = node.sdo.read_uint(communication + 0x200, 0, default=0)
        entries = [node.sdo.read_uint(communication + 0x200, n + 1, default=0) for n in range(min(count, 64))]
        mapped = [Mapped(e >> 16, e >> 8 & 0xFF, e & 0xFF) for e in entries]
        yield communication, identifier & 0x7FF, node.sdo.read_uint(communication, 2, default=AT_ONCE), mapped


def ours(node: Node, communication: int, identifier: int, kind: int, objects: Sequence[Mapped]) -> None:
    """One PDO as we want it; as it was when the node refuses. Raises Refused, NotReady."""
    before = node.sdo.read(communication, 1, b"")
    try:
        map_pdo(node, communication, identifier, kind, objects)
    except Refused:
        if before:
            node.sdo.restore(communication, 1, before)
        raise


class Inputs:
    """The objects a device tells, from whatever PDOs they come in. `values` are the newest, in the order asked for."""

    def __init__(self, node: Node, period: float = 0.001, base: Sequence[int] = (0x180, 0x280)) -> None:
        self.node = node
        self.period = period  # s between frames of one that follows no SYNC, where it takes a timer
        self.values: list[float] = []
        self.wrong = ""  # what is wrong with its frames, in words
        self._identifiers = [b + node.number for b in base]
        self._layouts: list[Layout] = []

    def arrange(self, groups: Sequence[Sequence[Mapped]], optional: Sequence[Mapped] = ()) -> None:
        """Have each group sent in a PDO of its own after every SYNC; where the node refuses, find the objects in what
        it sends: `optional` ones that are not there read NaN. Raises NotReady, naming what is missing.
        """
        wanted = [o for group in groups for o in group]
        self.values = [math.nan] * len(wanted)
        try:
            for n, group in enumerate(groups):
                ours(self.node, 0x1800 + n, self._identifiers[n], EACH_SYNC, group)
        except Refused as why:
            self._layouts = self._as_they_are(wanted, optional, str(why))
            return
        for n in range(len(groups), 4):
            switch_off_pdo(self.node, 0x1800 + n)
        made = [layout(self._identifiers[n], group, wanted) for n, group in enumerate(groups)]
        self._layouts = [one for one in made if one is not None]

    def _as_they_are(self, wanted: Sequence[Mapped], optional: Sequence[Mapped], why: str) -> list[Layout]:
        found: list[Layout] = []
        for communication, identifier, kind, mapped in present(self.node, 0x1800):
            missing = set(range(len(wanted))).difference(*(one.slots for one in found))
            one = layout(identifier, mapped, wanted)
            if one is not None and missing & set(one.slots):
                found.append(one._replace(time=self._timed(communication, kind)))
        told = set().union(*(one.slots for one in found)) if found else set()
        if lacking := [f"{o.at:04X}h" for n, o in enumerate(wanted) if n not in told and o not in optional]:
            raise NotReady(f"{why}; and in the PDOs it sends of its own there is no {' and no '.join(lacking)}")
        self.node.remarks.append(f"{self.node.who} keeps its own PDOs ({why}): they hold all that is needed")
        return found

    def _timed(self, communication: int, kind: int) -> Callable[[Frame], float]:
        """When its readings are made, by its transmission type; after every SYNC if it can be had."""
        if kind == EACH_SYNC:
            return LATCHED
        try:
            self.node.sdo.write(communication, 2, bytes((EACH_SYNC,)))
        except Refused as why:
            if kind not in EVENTS:
                how = "only after a change" if kind == AFTER_CHANGE else "on another count of SYNCs"
                raise NotReady(f"{why}: it sends {how} (type {kind}), expected after each SYNC") from None
            keep_sending(self.node, communication, self.period)
            self.node.remarks.append(
                f"{self.node.who} does not follow SYNC: its readings are stamped when they come, not when they are made"
            )
            return ARRIVED
        return LATCHED

    @property
    def identifiers(self) -> tuple[int, ...]:
        """Of the frames that carry them."""
        return tuple(one.identifier for one in self._layouts)

    @property
    def there(self) -> bool:
        """True when all of them have come."""
        return all(one.identifier in self.node.bus.frames for one in self._layouts)

    @property
    def silent(self) -> str:
        """Which of its frames stays away while others come, in words."""
        frames = self.node.bus.frames
        heard = {f"frame 0x{i:03X}": frames[i].arrived for i in self.identifiers if i in frames}
        told = missing(heard, self.period)
        return f"of {self.node.who} {told}" if told else ""

    def first(self, seconds: float) -> None:
        """Throw away what came before, ask by a SYNC, wait; ask again: a node that was started just now may have missed
        the first. Raises NotReady when nothing comes."""
        bus = self.node.bus
        for identifier in self.identifiers:
            bus.frames.pop(identifier, None)
        until = bus.clock.now() + seconds
        while (left := until - bus.clock.now()) > 0.0:
            bus.sync()
            if bus.wait(min(AGAIN, left), lambda: self.there) or bus.dead:
                break
        if not self.there:
            unasked = any(one.time is ARRIVED for one in self._layouts)
            why = "does it tell changes only? Then set its event timer 180xh:5" if unasked else "is it filtered?"
            raise NotReady(f"{self.node.who} sent no PDOs within {seconds:g} s: {why}")

    def take(self) -> float:
        """The newest numbers into `values`; the time [s] of the oldest frame among them, NEVER before all are there.

        A frame of another length than mapped is `wrong`, and changes nothing.
        """
        answer: Frame | None = None
        frames, oldest = self.node.bus.frames, math.inf
        for identifier, packing, slots, time in self._layouts:
            frame = frames.get(identifier)
            if frame is None:
                return NEVER
            if len(frame.data) != packing.size:
                self.wrong = self.wrong or (
                    f"{self.node.who} sends a PDO of {len(frame.data)} bytes, expected {packing.size}: mapped anew?"
                )
                return NEVER
            for slot, number in zip(slots, packing.unpack(frame.data), strict=True):
                self.values[slot] = number
            oldest = min(oldest, time(frame))
            if time is LATCHED:
                answer = frame
        if answer is not None:
            self.node.answered(answer)
        return oldest


class Outputs:
    """The objects a device is told, in one RPDO of ours or in those it has. Their order is that of `arrange`."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self._layouts: list[Layout] = []

    def arrange(self, needed: Sequence[Mapped], known: Sequence[Mapped]) -> None:
        """`needed` in one RPDO, taken at once; where the node refuses, in RPDOs it has, whose every object is `needed`
        or among the `known` ones that follow them. Raises NotReady.
        """
        identifier = 0x200 + self.node.number
        try:
            ours(self.node, 0x1400, identifier, AT_ONCE, needed)
        except Refused as why:
            self._layouts = self._as_they_are(needed, [*needed, *known], str(why))
            return
        for n in range(1, 4):
            switch_off_pdo(self.node, 0x1400 + n)
        made = layout(identifier, needed, needed)
        self._layouts = [made] if made else []

    def _as_they_are(self, needed: Sequence[Mapped], told: Sequence[Mapped], why: str) -> list[Layout]:
        found: list[Layout] = []
        for _, identifier, _, mapped in present(self.node, 0x1400):
            one = layout(identifier, mapped, told)
            if one is not None and len(one.slots) == len(mapped):  # nothing in it that we do not know
                found.append(one)
        have = {slot for one in found for slot in one.slots}
        if lacking := [f"{o.at:04X}h" for n, o in enumerate(needed) if n not in have]:
            raise NotReady(f"{why}; and in the PDOs it takes of its own there is no {' and no '.join(lacking)}")
        return found

    def send(self, *numbers: float) -> bool:
        """All of them, `needed` and `known`; False when the bus is dead. Never raises."""
        sent = True
        for identifier, packing, slots, _ in self._layouts:
            sent &= self.node.bus.send(identifier, packing.pack(*(numbers[slot] for slot in slots)))
        return sent
