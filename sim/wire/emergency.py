"""What a node says about its errors: register 1001, history 1003, emergency messages      [cia301]"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import final

from sim.wire.objects import U8, U32, Abort, AbortCode, Entry, Objects
from sim.wire.pdo import OFF

GENERIC, COMMUNICATION, PROFILE = 0x01, 0x10, 0x20  # bits of the error register 1001
HEARTBEAT_LOST, RPDO_SHORT, RPDO_LATE = 0x8130, 0x8210, 0x8250  # emergency codes
HISTORY = 8  # errors kept in 1003
VENDOR_BYTES = 5  # of an emergency message


@final
class Emergencies:
    """`send` takes identifier and data; whether the node may speak at all is its business."""

    def __init__(self, objects: Objects, node_id: int, send: Callable[[int, bytes], None]) -> None:
        self._send = send
        self._past: list[int] = []
        self.register = objects.add(0x1001, Entry(U8, 0, "r", mappable=True))
        objects.add(0x1003, Entry(U8, 0, read=lambda: len(self._past), write=self._clear))
        for place in range(HISTORY):
            objects.add(0x1003, Entry(U32, 0, "r", read=lambda n=place: self._code(n)), place + 1)  # type: ignore[misc]
        self._cob = objects.add(0x1014, Entry(U32, 0x80 + node_id))

    def report(self, code: int, register: int, more: bytes = b"") -> None:
        """An error has come: send, remember; `register` are the bits it sets in 1001 besides the generic one."""
        self.register.value = self.register.number | register | GENERIC
        self._past = [code, *self._past][:HISTORY]
        self._say(code, more)

    def recovered(self) -> None:
        """All errors are gone: EMCY 0000."""
        self.register.value = 0
        self._say(0, b"")

    def _say(self, code: int, more: bytes) -> None:
        if not self._cob.number & OFF:
            data = struct.pack("<HB", code, self.register.number) + more[:VENDOR_BYTES].ljust(VENDOR_BYTES, b"\0")
            self._send(self._cob.number & 0x7FF, data)

    def _clear(self, value: float) -> None:
        if value:
            raise Abort(AbortCode.VALUE)
        self._past = []

    def _code(self, place: int) -> int:
        if place >= len(self._past):
            raise Abort(AbortCode.NO_SUBINDEX)
        return self._past[place]
