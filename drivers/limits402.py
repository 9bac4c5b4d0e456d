"""What a CiA 402 drive is told to keep to by itself: torque, following error, how its torque goes off      [cia402]

All of these objects are optional: what is not there, or will not be set, is said in a sentence and done without.
"""

from __future__ import annotations

import math
import struct

from drivers.node import Node
from drivers.sdo import Refused
from drivers.targets402 import PERMILLE
from drivers.wiring import Place
from rig.core.units import TURN

PATIENCE = 50  # ms outside of the following error window before the drive faults: the guard, which says why, is faster
WIDEST = 0xFFFFFFFE  # counts: 0xFFFFFFFF would switch the window off
FAULTS = 1  # of 6007h: a lost connection is a fault
REACTIONS = (0x605A, 0x605C, 0x605E)  # quick stop, disable operation, fault reaction


def set_limits(node: Node, place: Place) -> None:
    """Write and read back 6072h, 6065h, 6066h, 6007h and the reactions. Raises NotReady when the node is silent."""
    torque = min(round(place.torque_limit / place.torque_rated * PERMILLE), 0xFFFF)
    _prefer(node, 0x6072, struct.pack("<H", torque), "its torque is limited by this program alone")
    if place.following:
        _limit_lag(node, place)
    _prefer(node, 0x6007, struct.pack("<h", FAULTS), "what it does when this program falls silent is its own choice")
    for code in REACTIONS:  # drive function off
        _prefer(node, code, struct.pack("<h", 0), "it reacts in a way of its own before its torque goes off")


def _limit_lag(node: Node, place: Place) -> None:
    """The drive's own watch over its position loop, as wide as the guard's at its widest. Other modes have none."""
    alone = "in position mode this program alone watches how far it lags"
    window = min(math.ceil(place.following / TURN * place.counts_per_turn), WIDEST)
    if not _prefer(node, 0x6065, struct.pack("<I", window), alone):
        node.remarks.append(f"{node.who} has no following error window (6065h): {alone}")
        return
    if not _prefer(node, 0x6066, struct.pack("<H", PATIENCE), "it may lag for another time before it faults"):
        node.remarks.append(f"{node.who} has no following error time-out (6066h): it faults when it pleases")


def _prefer(node: Node, index: int, value: bytes, otherwise: str) -> bool:
    """Write an object; one that insists on another value is remarked on. False when it is not there."""
    try:
        return node.sdo.write_if_there(index, 0, value)
    except Refused as why:
        node.remarks.append(f"{why}: {otherwise}")
        return True
