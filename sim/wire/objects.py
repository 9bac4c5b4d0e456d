"""The object dictionary of a CANopen node: what each index holds, who may change it, what a write does."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Mapping
from enum import IntEnum
from typing import NamedTuple

Value = float | bytes  # integers are floats to the type checker; text is bytes


class AbortCode(IntEnum):
    """SDO abort codes      [cia301, SDO abort transfer]"""

    TOGGLE = 0x05030000
    COMMAND = 0x05040001
    UNSUPPORTED = 0x06010000
    WRITE_ONLY = 0x06010001
    READ_ONLY = 0x06010002
    NO_OBJECT = 0x06020000
    NOT_MAPPABLE = 0x06040041
    MAP_TOO_LONG = 0x06040042
    LENGTH = 0x06070010
    TOO_LONG = 0x06070012
    TOO_SHORT = 0x06070013
    NO_SUBINDEX = 0x06090011
    VALUE = 0x06090030
    TOO_HIGH = 0x06090031
    TOO_LOW = 0x06090032
    GENERAL = 0x08000000
    STATE = 0x08000022


class Abort(Exception):
    """An access the node refuses, with the code it answers."""

    def __init__(self, code: AbortCode) -> None:
        super().__init__(f"SDO abort 0x{code:08X} ({code.name})")
        self.code = code


class Kind(NamedTuple):
    """A basic data type: its struct format (little-endian) and its size in bytes; 0 bytes: text of any length."""

    format: str
    size: int

    def pack(self, value: Value) -> bytes:
        """Value to bytes."""
        if isinstance(value, bytes):
            return value
        return struct.pack(self.format, value if self.format == "<f" else int(value))

    def unpack(self, data: bytes) -> Value:
        """Bytes to value. Raises Abort when their number is wrong."""
        if not self.size:
            return data
        if len(data) != self.size:
            raise Abort(AbortCode.TOO_LONG if len(data) > self.size else AbortCode.TOO_SHORT)
        value: float = struct.unpack(self.format, data)[0]
        return value


U8, U16, U32 = Kind("<B", 1), Kind("<H", 2), Kind("<I", 4)
I8, I16, I32 = Kind("<b", 1), Kind("<h", 2), Kind("<i", 4)
REAL32, TEXT = Kind("<f", 4), Kind("", 0)


class Entry:
    """One sub-index. `read` makes the value where it is not kept here; `write` may refuse a value, or act on it."""

    __slots__ = ("kind", "mappable", "read", "readable", "value", "writable", "write")

    def __init__(
        self,
        kind: Kind,
        value: Value = 0,
        access: str = "rw",
        read: Callable[[], float] | None = None,
        write: Callable[[float], None] | None = None,
        mappable: bool = False,
    ) -> None:
        self.kind, self.value, self.mappable = kind, value, mappable
        self.readable, self.writable = "r" in access, "w" in access
        self.read, self.write = read, write

    def data(self) -> bytes:
        """Its value now, as bytes."""
        return self.kind.pack(self.value if self.read is None else self.read())

    def accept(self, data: bytes) -> None:
        """Take a new value. Raises Abort."""
        value = self.kind.unpack(data)
        if self.write is not None:
            assert not isinstance(value, bytes)
            self.write(value)
        self.value = value

    @property
    def number(self) -> int:
        """The kept value as a whole number."""
        return int(self.value)


class Objects:
    """Index and sub-index to entry."""

    def __init__(self) -> None:
        self._entries: dict[int, dict[int, Entry]] = {}

    def add(self, index: int, entry: Entry, sub: int = 0) -> Entry:
        """Put `entry` there."""
        self._entries.setdefault(index, {})[sub] = entry
        return entry

    def record(self, index: int, entries: Mapping[int, Entry]) -> None:
        """Several sub-indices, with the highest of them in sub-index 0."""
        self.add(index, Entry(U8, max(entries), "r"))
        for sub, entry in entries.items():
            self.add(index, entry, sub)

    def find(self, index: int, sub: int) -> Entry:
        """The entry there. Raises Abort: no such object, no such sub-index."""
        if index not in self._entries:
            raise Abort(AbortCode.NO_OBJECT)
        if sub not in self._entries[index]:
            raise Abort(AbortCode.NO_SUBINDEX)
        return self._entries[index][sub]

    def __iter__(self) -> Iterator[tuple[int, int, Entry]]:
        for index, subs in self._entries.items():
            for sub, entry in subs.items():
                yield index, sub, entry
