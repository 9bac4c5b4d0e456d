"""What stops a CiA 402 drive by itself when this program falls silent      [cia301, cia402]

Two ways are used, the first that the drive has: its heartbeat consumer 1016h, or the time-out of its RPDO 1400h:5.
"""

from __future__ import annotations

import contextlib
import struct

from drivers.node import Node
from drivers.sdo import Refused
from rig.core.devices import Watchdog

NOTHING = 0  # of 6007h: a lost connection is nothing to the drive
NO_CHANGE = 1  # of 1029h:1: a lost connection changes nothing in the node
HEARTBEAT, RPDO = 0x1016, 0x1400


def arm(node: Node, limit: int) -> tuple[Watchdog, int]:
    """Set it to `limit` ms; what guards, and the object that was set, 0 for none. Raises NotReady when the node is
    silent."""
    if not _stops_when_alone(node):
        return Watchdog(), 0
    host = node.bus.host_node
    with contextlib.suppress(Refused):
        if host and node.sdo.write_if_there(HEARTBEAT, 1, struct.pack("<I", host << 16 | limit)):
            return _set("heartbeat consumer", limit), HEARTBEAT
    with contextlib.suppress(Refused):
        if node.sdo.write_if_there(RPDO, 5, struct.pack("<H", limit)):
            return _set("RPDO timeout", limit), RPDO
    return Watchdog(), 0


def _set(what: str, limit: int) -> Watchdog:
    return Watchdog(f"{what} of the drive, {limit} ms, set and read back", is_proven=True)


def disarm(node: Node, armed: int) -> None:
    """Between runs nobody talks to the drive, and that is no fault. Raises NotReady."""
    if armed == HEARTBEAT:
        node.sdo.put(HEARTBEAT, 1, struct.pack("<I", 0))
    elif armed == RPDO:
        node.sdo.put(RPDO, 5, struct.pack("<H", 0))


def _stops_when_alone(node: Node) -> bool:
    """Whether a lost connection, once noticed, stops the drive, as far as it says."""
    reaction = node.sdo.read(0x6007, 0, b"")
    if reaction:
        return int.from_bytes(reaction[:2], "little") != NOTHING
    return node.sdo.read_uint(0x1029, 1, default=0) != NO_CHANGE
