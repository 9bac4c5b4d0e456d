"""What stops a CiA 402 drive by itself when this program falls silent      [cia301, cia402]

Two ways are used, the first that the drive has: its heartbeat consumer 1016h, or the time-out of its RPDO 1400h:5.
"""

from __future__ import annotations

import contextlib
import struct

from drivers.node import Node
from drivers.sdo import Refused

NOTHING = 0  # of 6007h: a lost connection is nothing to the drive
NO_CHANGE = 1  # of 1029h:1: a lost connection changes nothing in the node
HEARTBEAT = "heartbeat consumer of the drive"


def arm(node: Node, limit: int) -> str:
    """Set it to `limit` ms; what guards, in words, "" when nothing does. Raises NotReady when the node is silent."""
    if not _stops_when_alone(node):
        return ""
    host = node.bus.host_node
    with contextlib.suppress(Refused):
        if host and node.sdo.write_if_there(0x1016, 1, struct.pack("<I", host << 16 | limit)):
            return f"{HEARTBEAT}, {limit} ms, set and read back"
    with contextlib.suppress(Refused):
        if node.sdo.write_if_there(0x1400, 5, struct.pack("<H", limit)):
            return f"RPDO timeout of the drive, {limit} ms, set and read back"
    return ""


def disarm(node: Node, guarded: str) -> None:
    """Between runs nobody talks to the drive, and that is no fault. Raises NotReady."""
    if guarded.startswith(HEARTBEAT):
        node.sdo.put(0x1016, 1, struct.pack("<I", 0))
    elif guarded:
        node.sdo.put(0x1400, 5, struct.pack("<H", 0))


def _stops_when_alone(node: Node) -> bool:
    """Whether a lost connection, once noticed, stops the drive, as far as it says."""
    reaction = node.sdo.read(0x6007, 0, b"")
    if reaction:
        return int.from_bytes(reaction[:2], "little") != NOTHING
    return node.sdo.read_uint(0x1029, 1, default=0) != NO_CHANGE
