"""Choosing a mode of operation: what 6502h lists, what 6060h takes, what 6061h confirms      [cia402]

Lists are wrong on some drives and 6061h is late on others, so what counts is that 6061h shows the mode in the end.
"""

from __future__ import annotations

import contextlib
import struct

from drivers.node import Node
from drivers.sdo import Refused
from drivers.targets402 import TARGETS
from rig.core.errors import NotReady
from rig.core.sample import Mode

UNDECIDED = 0  # in 6061h: no mode yet; some drives show theirs only once they are enabled
PATIENCE = 0.3  # s for 6061h to follow 6060h


def choose(node: Node, mode: Mode) -> None:
    """Write 6060h. Raises NotReady when the drive will not, or does not list the mode and does not take it either."""
    target = TARGETS[mode]
    if node.sdo.lacks(target.object.at):  # small nodes take it into a PDO all the same
        raise NotReady(f"{node.who} has no target {mode} ({target.object.at:04X}h): it cannot be run in that mode")
    listed = node.sdo.read_uint(0x6502, default=target.supported)
    bit = target.supported.bit_length() - 1
    unlisted = f"{node.who} does not offer cyclic {mode} mode (6502h = {listed:#x}, bit {bit} is 0)"
    try:
        node.sdo.put(0x6060, 0, struct.pack("<b", target.number))  # some cannot be read
    except Refused as why:
        if not shows(node, mode):
            raise Refused(f"{why}" if listed & target.supported else unlisted) from None
    if listed & target.supported:
        return
    if not shows(node, mode):
        raise NotReady(unlisted)
    node.remarks.append(f"{unlisted}; it took it all the same, as 6061h shows")


def shows(node: Node, mode: Mode) -> bool:
    """6061h confirms the mode, at once or in a while. Raises NotReady."""
    clock, wanted = node.bus.clock, TARGETS[mode].number
    until = clock.now() + PATIENCE
    while (told := shown(node)) != wanted:
        if told is None or clock.now() > until:
            return False
        node.bus.wait(0.005, lambda: False)
    return True


def shown(node: Node) -> int | None:
    """6061h; None where it cannot be read. Raises NotReady when the node is silent."""
    raw = node.sdo.read(0x6061, 0, b"")
    return int.from_bytes(raw[:1], "little", signed=True) if raw else None


def rest_all(node: Node) -> None:
    """Targets of every mode that ask for nothing: no torque, rest, the place it is at. Raises NotReady."""
    place = node.sdo.read(0x6064, 0, b"")
    for target in TARGETS.values():
        rest = place if target is TARGETS[Mode.POSITION] else bytes(target.object.bits // 8)
        with contextlib.suppress(Refused):  # it has no such target: nor such a mode
            node.sdo.put(target.object.at, 0, rest)
