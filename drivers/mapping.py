"""Setting up the PDOs of a node: off, emptied, mapped, on      [cia301, 7.5.2.35-38]

What a node's maker chose besides is left as it is (bit 30 of an identifier), or is switched off where it would send on
its own beside SYNC (event timers, inhibit times, SYNC start values).
"""

from __future__ import annotations

import contextlib
import struct
from collections.abc import Sequence
from typing import NamedTuple

from drivers.node import Node
from drivers.sdo import Refused

INVALID = 1 << 31  # of a PDO's identifier: not in use
EXTENDED = 1 << 29  # 29 bits long
KEPT = 1 << 30  # no remote frames: many nodes insist on it
EVENTS = (254, 255)  # transmission types: when its maker says so
BESIDE = ((3, "inhibit time"), (5, "event timer"), (6, "SYNC start value"))  # sub-indices


class Mapped(NamedTuple):
    """One object in a PDO."""

    at: int  # index
    sub: int
    bits: int
    form: str = ""  # of its number, as struct writes it


def map_pdo(node: Node, communication: int, identifier: int, kind: int, objects: Sequence[Mapped]) -> None:
    """Set up one PDO. `communication` 1400h… or 1800h…, `kind` its transmission type. Raises NotReady, naming what is
    refused.
    """
    mapping = communication + 0x200
    identifier |= node.sdo.read_uint(communication, 1, default=0) & KEPT
    node.sdo.put(communication, 1, struct.pack("<I", identifier | INVALID))
    node.sdo.write(communication, 2, bytes((kind,)))
    if communication >= 0x1800:
        quieten(node, communication)
    node.sdo.put(mapping, 0, b"\0")  # many drives refuse entries while the number is not zero
    for place, (index, sub, bits, _) in enumerate(objects, 1):
        node.sdo.write(mapping, place, struct.pack("<I", index << 16 | sub << 8 | bits))
    node.sdo.write(mapping, 0, bytes((len(objects),)))
    node.sdo.put(communication, 1, struct.pack("<I", identifier))
    told = node.sdo.read_uint(communication, 1)
    if told & ~KEPT != identifier & ~KEPT:
        raise Refused(f"{node.who}: wrote {identifier:08X}h to {communication:04X}h:1, it reads back {told:08X}h")


def quieten(node: Node, communication: int) -> None:
    """A TPDO that follows SYNC sends for no other reason. What will not be switched off is remarked on."""
    for sub, name in BESIDE:
        if node.sdo.read_uint(communication, sub, default=0):
            try:
                node.sdo.write(communication, sub, bytes(1 if sub == 6 else 2))
            except Refused as why:
                node.remarks.append(f"{why}: its {name} stays, and frames come that no SYNC has asked for")


def keep_sending(node: Node, communication: int, period: float) -> None:
    """A TPDO that follows no SYNC is sent every `period` s, changed or not: silence has to mean that it is dead.

    Nothing where its maker set a timer that is as fast. A node that takes none is found out when it falls silent.
    """
    wanted = max(round(period * 1000), 1)  # ms
    if not 0 < node.sdo.read_uint(communication, 5, default=0) <= wanted:
        with contextlib.suppress(Refused):
            node.sdo.write(communication, 5, struct.pack("<H", wanted))


def switch_off_pdo(node: Node, communication: int) -> None:
    """A PDO not wanted on the bus; nothing when the node has none such. Raises NotReady."""
    present = node.sdo.read(communication, 1, b"")
    if present and not int.from_bytes(present, "little") & INVALID:
        with contextlib.suppress(Refused):  # then it is sent: unread, and told by the load of the bus
            node.sdo.put(communication, 1, struct.pack("<I", int.from_bytes(present, "little") | INVALID))
