"""The line between station and web process: one JSON object a packet, both ways; sending never waits."""

from __future__ import annotations

import json
import select
import socket
from collections import deque
from typing import Any, final

LONGEST = 1 << 18  # bytes of a packet
KEPT = 2000  # packets that wait for a reader who is slow; older ones go first


@final
class Channel:
    """One end. `post` keeps what the other end has no room for, `offer` drops it: the next picture says more.

    Once the other end is gone, nothing is sent or received any more and `closed` is True.
    """

    def __init__(self, line: socket.socket) -> None:
        line.setblocking(False)
        self._line = line
        self._waiting: deque[bytes] = deque(maxlen=KEPT)
        self.closed = False
        self.dropped = 0  # offers nobody had room for

    def fileno(self) -> int:
        """For select."""
        return self._line.fileno()

    def post(self, message: dict[str, Any]) -> None:
        """Something that must arrive, in order."""
        self._waiting.append(_packet(message))
        self.flush()

    def offer(self, message: dict[str, Any]) -> bool:
        """Something that is worth sending only now; False when there was no room."""
        self.flush()
        if not self._waiting and self._send(_packet(message)):
            return True
        self.dropped += 1
        return False

    def flush(self) -> None:
        """Send what waits, as far as there is room."""
        while self._waiting and self._send(self._waiting[0]):
            self._waiting.popleft()

    def receive(self, timeout: float = 0.0) -> list[dict[str, Any]]:
        """What has arrived; waits up to `timeout` s for the first."""
        if self.closed:
            return []
        if timeout > 0.0:
            select.select([self._line], [], [], timeout)
        found = []
        while (packet := self._take()) is not None:
            message = json.loads(packet)
            if isinstance(message, dict):
                found.append(message)
        return found

    def _take(self) -> bytes | None:
        try:
            packet = self._line.recv(LONGEST)
        except BlockingIOError:
            return None
        except OSError:
            packet = b""
        if not packet:
            self.closed = True
            return None
        return packet

    def _send(self, packet: bytes) -> bool:
        if self.closed:
            return True  # to nobody
        try:
            self._line.send(packet)
        except BlockingIOError:
            return False
        except OSError:
            self.closed = True
        return True

    def close(self) -> None:
        """Idempotent."""
        self.closed = True
        self._line.close()


def _packet(message: dict[str, Any]) -> bytes:
    return json.dumps(message, ensure_ascii=False, separators=(",", ":")).encode(errors="replace")
