"""A CAN bus on a Unix socket, as python-can sees it: can.Bus(interface="hdrig-unix", channel="/path/to/socket").

For machines without kernel CAN, and for the twin. One SOCK_SEQPACKET packet of 24 bytes is one frame, little-endian,
both ways; the first 16 bytes are `struct can_frame` of linux/can.h:

    0   u32      identifier; bit 31: 29 bits long, bit 30: remote frame, bit 29: error frame
    4   u8       number of data bytes, 0 to 8
    5   3 × u8   zero
    8   8 × u8   data, padded with zeros
    16  u64      ns on CLOCK_MONOTONIC at which the frame had passed on the bus; not looked at in frames sent

Nobody hears their own frames. Who does not read loses frames without a word, as with a kernel's receive queue.
"""

from __future__ import annotations

import select
import socket
import struct
import time
from typing import Any

from rig.core.can_libraries import can

FRAME = struct.Struct("<IB3x8sQ")
EXTENDED, REMOTE, ERROR = 1 << 31, 1 << 30, 1 << 29
IDENTIFIER = (1 << 29) - 1


class UnixBus(can.BusABC):
    """python-can's view of the socket. Time stamps count from 1970 as everywhere in python-can, but do not step.

    Raises CanInitializationError when nobody listens at `channel`; `send` and `recv` raise CanOperationError when the
    other side is gone, `send` also when it takes no more frames.
    """

    def __init__(self, channel: str, can_filters: can.typechecking.CanFilters | None = None, **kwargs: Any) -> None:
        self.channel_info = f"hdrig-unix {channel}"
        self._epoch = time.time() - time.monotonic()  # s, fixed: a step of the wall clock moves no time stamp
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        try:
            self._socket.connect(str(channel))
        except OSError as error:
            self._socket.close()
            self._is_shutdown = True  # or python-can complains about a bus that never was
            raise can.CanInitializationError(f"no CAN bus at {channel}: {error.strerror}") from None
        self._socket.setblocking(False)
        super().__init__(channel=channel, can_filters=can_filters, **kwargs)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Hand one frame over; waits `timeout` s at most for room, by default not at all."""
        packet = encode(msg)
        try:
            try:
                self._socket.send(packet)
            except BlockingIOError:
                if not timeout or not select.select([], [self._socket], [], timeout)[1]:
                    raise can.CanOperationError(f"{self.channel_info}: transmit queue full") from None
                self._socket.send(packet)
        except OSError as error:
            raise can.CanOperationError(f"{self.channel_info}: cannot send, {error.strerror}", error.errno) from None

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        try:
            try:
                packet = self._socket.recv(FRAME.size)
            except BlockingIOError:
                if timeout == 0 or not select.select([self._socket], [], [], timeout)[0]:
                    return None, False
                packet = self._socket.recv(FRAME.size)
        except OSError as error:
            raise can.CanOperationError(f"{self.channel_info}: cannot receive, {error.strerror}", error.errno) from None
        if len(packet) != FRAME.size:
            raise can.CanOperationError(f"{self.channel_info}: the bus is gone")
        return decode(packet, self._epoch), False

    def fileno(self) -> int:
        """For select and for python-can's Notifier."""
        return self._socket.fileno()

    def shutdown(self) -> None:
        """Leave the bus. Idempotent."""
        super().shutdown()
        self._socket.close()


def encode(msg: can.Message) -> bytes:
    """The packet of a message to be sent."""
    flags = msg.is_extended_id * EXTENDED | msg.is_remote_frame * REMOTE | msg.is_error_frame * ERROR
    return FRAME.pack(msg.arbitration_id | flags, msg.dlc, bytes(msg.data), 0)


def decode(packet: bytes, epoch: float) -> can.Message:
    """The message in a packet; `epoch` s lie between 1970 and the monotonic clock's zero."""
    identifier, size, data, passed = FRAME.unpack(packet)
    remote = bool(identifier & REMOTE)
    return can.Message(
        timestamp=epoch + passed * 1e-9,
        arbitration_id=identifier & IDENTIFIER,
        is_extended_id=bool(identifier & EXTENDED),
        is_remote_frame=remote,
        is_error_frame=bool(identifier & ERROR),
        dlc=size,
        data=b"" if remote else data[:size],
    )
