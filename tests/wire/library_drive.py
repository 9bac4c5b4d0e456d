"""A CiA 402 drive on somebody else's stack: SDO server, NMT and heartbeat are the Python library canopen's own.

Its object dictionary is nobody's we know, and as short as asked for; PDOs follow the mapping that was written into it.
"""

from __future__ import annotations

import contextlib
import struct
from collections.abc import Mapping
from typing import Any

import canopen
from canopen.objectdictionary import (
    INTEGER8,
    INTEGER16,
    INTEGER32,
    OCTET_STRING,
    UNSIGNED8,
    UNSIGNED16,
    UNSIGNED32,
    ODRecord,
    ODVariable,
)

Address = tuple[int, int]
SIZES = {1: UNSIGNED8, 2: UNSIGNED16, 4: UNSIGNED32}
CANNOT_BE_MAPPED = 0x06040041  # abort code
FOLLOWS = {(0x40, 0x06): 0x21, (0x21, 0x07): 0x23, (0x23, 0x0F): 0x27}  # state, controlword: next state  [cia402]
OBJECTS: dict[Address, tuple[int, Any]] = {  # type, value at power-on
    (0x1000, 0): (UNSIGNED32, 0x00420192),
    (0x1001, 0): (UNSIGNED8, 0),
    (0x1008, 0): (OCTET_STRING, b"\xb5Servo #7\0"),
    (0x1017, 0): (UNSIGNED16, 0),
    (0x1018, 0): (UNSIGNED8, 2),
    (0x1018, 1): (UNSIGNED32, 0xFFFFFFFF),
    (0x1018, 2): (UNSIGNED32, 0),
    (0x6040, 0): (UNSIGNED16, 0),
    (0x6041, 0): (UNSIGNED16, 0x0040),
    (0x6060, 0): (INTEGER8, 0),
    (0x6061, 0): (INTEGER8, 0),
    (0x6064, 0): (INTEGER32, -123),
    (0x6071, 0): (INTEGER16, 0),
    (0x6077, 0): (INTEGER16, 0),
}


def pdo(communication: int, identifier: int, entries: int = 4) -> dict[Address, tuple[int, Any]]:
    """Communication and mapping of one PDO, switched off and empty."""
    mapping = communication + 0x200
    return {
        (communication, 0): (UNSIGNED8, 2),
        (communication, 1): (UNSIGNED32, 1 << 31 | identifier),
        (communication, 2): (UNSIGNED8, 255),
        (mapping, 0): (UNSIGNED8, 0),
        **{(mapping, n + 1): (UNSIGNED32, 0) for n in range(entries)},
    }


def dictionary(objects: Mapping[Address, tuple[int, Any]]) -> canopen.ObjectDictionary:
    """As the library wants it: plain variables, and records for what has sub-indices."""
    made = canopen.ObjectDictionary()
    several = {index for index, sub in objects if sub}
    for index in several:
        made.add_object(ODRecord(f"record {index:04X}h", index))
    for (index, sub), (kind, value) in objects.items():
        variable = ODVariable(f"{index:04X}h:{sub}", index, sub)
        variable.data_type, variable.access_type, variable.default = kind, "rw", value
        if index in several:
            made[index].add_member(variable)
        else:
            made.add_object(variable)
    return made


class LibraryDrive:
    """Node `number` on python-can's virtual bus `channel`, booted when made; `lacks` are objects it does not have."""

    def __init__(self, channel: str, number: int, lacks: frozenset[int] = frozenset()) -> None:
        pdos = pdo(0x1400, 0x200 + number) | pdo(0x1800, 0x180 + number) | pdo(0x1801, 0x280 + number)
        objects = OBJECTS | pdos
        left = {at: what for at, what in objects.items() if at[0] not in lacks and at[0] - 0x200 not in lacks}
        self.network = canopen.Network()
        self.network.connect(interface="virtual", channel=channel)
        self.node = canopen.LocalNode(number, dictionary(left))
        self.network.add_node(self.node)
        self.node.add_write_callback(self._written)
        self.network.subscribe(0x080, self._on_sync)
        self.network.subscribe(0x200 + number, self._on_command)
        with contextlib.suppress(KeyError):  # the library asks for 1017h when it has booted
            self.node.nmt.state = "PRE-OPERATIONAL"

    def number(self, index: int, sub: int = 0) -> int:
        """What stands in its object dictionary now, unsigned."""
        return int.from_bytes(self.node.get_data(index, sub), "little")

    def _written(self, index: int, subindex: int, od: Any, data: bytes) -> None:
        if index == 0x6060 and 0x6061 in self.node.object_dictionary:
            self.node.set_data(0x6061, 0, data)
        if index >> 9 in (0x1600 >> 9, 0x1A00 >> 9) and subindex and any(data):
            self._refuse_absent(int.from_bytes(data, "little") >> 16)
        if index == 0x6040 and 0x6041 in self.node.object_dictionary:
            word, now = int.from_bytes(data, "little"), self.number(0x6041) & 0x6F
            state = FOLLOWS.get((now, word), now) if word & 0x02 else 0x40
            self.node.set_data(0x6041, 0, struct.pack("<H", state))

    def _refuse_absent(self, index: int) -> None:
        """The library would take a mapping of anything."""
        if index not in self.node.object_dictionary:
            raise canopen.SdoAbortedError(CANNOT_BE_MAPPED)

    def _mapped(self, communication: int) -> list[Address]:
        count = self.number(communication + 0x200, 0)
        entries = [self.number(communication + 0x200, n + 1) for n in range(count)]
        return [(entry >> 16, entry >> 8 & 0xFF) for entry in entries]

    def _on_sync(self, identifier: int, data: bytes, timestamp: float) -> None:
        if self.node.nmt.state != "OPERATIONAL":
            return
        for communication in (0x1800, 0x1801):
            where = self.number(communication, 1)
            if not where >> 31:
                told = b"".join(self.node.get_data(*at) for at in self._mapped(communication))
                self.network.send_message(where & 0x7FF, told)

    def _on_command(self, identifier: int, data: bytes, timestamp: float) -> None:
        if self.node.nmt.state != "OPERATIONAL":
            return
        for index, sub in self._mapped(0x1400):
            size = len(self.node.get_data(index, sub))
            self.node.set_data(index, sub, bytes(data[:size]))
            data = data[size:]

    def close(self) -> None:
        """Off the bus, its threads ended."""
        self.node.nmt.stop_heartbeat()
        self.network.disconnect()
