"""The SDO server of a node: expedited and segmented transfers, aborts; block transfer is refused      [cia301]"""

from __future__ import annotations

import struct
from collections.abc import Callable

from sim.wire.objects import Abort, AbortCode, Entry, Objects

ADDRESS = struct.Struct("<BHB")  # command, index, sub-index
EXPEDITED = 4  # bytes that fit into one frame
SEGMENT = 7  # bytes of a segment


class SdoServer:
    """`answer` sends the eight bytes of a response. One transfer at a time; a new one ends the one before."""

    def __init__(self, objects: Objects, answer: Callable[[bytes], None]) -> None:
        self.objects, self.answer = objects, answer
        self._address = (0, 0)
        self._toggle = 0
        self._left = b""  # of an upload
        self._taken: bytearray | None = None  # of a download
        self._announced: int | None = None  # its length, if the client said it
        self._uploading = False

    def request(self, data: bytes) -> None:
        """One request frame. Frames of other than eight bytes are not answered."""
        if len(data) != 8:
            return
        command = data[0]
        try:
            match command >> 5:
                case 1:
                    self._start_download(command, data)
                case 0:
                    self._download_segment(command, data)
                case 2:
                    self._start_upload(data)
                case 3:
                    self._upload_segment(command)
                case 4:
                    self._end()
                case _:
                    self._address = ADDRESS.unpack_from(data)[1:]
                    raise Abort(AbortCode.COMMAND)
        except Abort as abort:
            self._end()
            self.answer(ADDRESS.pack(0x80, *self._address) + struct.pack("<I", abort.code))

    def _end(self) -> None:
        self._taken, self._left, self._uploading = None, b"", False

    def _entry(self, data: bytes) -> Entry:
        self._end()
        self._address = ADDRESS.unpack_from(data)[1:]
        return self.objects.find(*self._address)

    def _start_download(self, command: int, data: bytes) -> None:
        entry = self._entry(data)
        if not entry.writable:
            raise Abort(AbortCode.READ_ONLY)
        sized = command & 1
        if command & 2:
            size = EXPEDITED - (command >> 2 & 3) if sized else entry.kind.size or EXPEDITED
            entry.accept(data[4 : 4 + size])
        else:
            self._taken, self._toggle = bytearray(), 0
            self._announced = struct.unpack_from("<I", data, 4)[0] if sized else None
        self.answer(ADDRESS.pack(0x60, *self._address) + bytes(4))

    def _download_segment(self, command: int, data: bytes) -> None:
        if self._taken is None:
            raise Abort(AbortCode.COMMAND)
        toggle = self._turn(command)
        self._taken += data[1 : 1 + SEGMENT - (command >> 1 & 7)]
        if command & 1:
            if self._announced not in (None, len(self._taken)):
                raise Abort(AbortCode.LENGTH)
            self.objects.find(*self._address).accept(bytes(self._taken))
            self._end()
        self.answer(bytes([0x20 | toggle]) + bytes(7))

    def _start_upload(self, data: bytes) -> None:
        entry = self._entry(data)
        if not entry.readable:
            raise Abort(AbortCode.WRITE_ONLY)
        value = entry.data()
        if 0 < len(value) <= EXPEDITED:
            head = ADDRESS.pack(0x43 | (EXPEDITED - len(value)) << 2, *self._address)
            self.answer(head + value.ljust(4, b"\0"))
            return
        self._left, self._toggle, self._uploading = value, 0, True
        self.answer(ADDRESS.pack(0x41, *self._address) + struct.pack("<I", len(value)))

    def _upload_segment(self, command: int) -> None:
        if not self._uploading:
            raise Abort(AbortCode.COMMAND)
        toggle = self._turn(command)
        part, self._left = self._left[:SEGMENT], self._left[SEGMENT:]
        last = not self._left
        self.answer(bytes([toggle | (SEGMENT - len(part)) << 1 | last]) + part.ljust(SEGMENT, b"\0"))
        self._uploading = not last

    def _turn(self, command: int) -> int:
        """The toggle bit of this segment. Raises Abort when the client's is the wrong one."""
        toggle = command & 0x10
        if toggle != self._toggle:
            raise Abort(AbortCode.TOGGLE)
        self._toggle ^= 0x10
        return toggle
