"""The bus's Unix socket: every client that connects is a station of its own.

SOCK_SEQPACKET, one packet of 24 bytes is one frame, little-endian: `struct can_frame` of linux/can.h (identifier u32
with bit 31: 29 bits, bit 30: remote, bit 29: error; length u8; 3 zero bytes; 8 data bytes), then u64 ns on
CLOCK_MONOTONIC at which the frame had passed. The time of frames from clients is not looked at.
"""

from __future__ import annotations

import socket
import struct
from collections.abc import Callable
from pathlib import Path
from typing import final

from rig.core.errors import NotReady
from sim.wire.bus import Bus
from sim.wire.frame import REMOTE, Frame
from sim.wire.reactor import Reactor, Source

PACKET = struct.Struct("<IB3x8sQ")


def listen(path: Path, kind: socket.SocketKind) -> socket.socket:
    """A listening Unix socket at `path`; what a dead twin left is replaced. Raises NotReady: a live one is there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.is_socket():
        with socket.socket(socket.AF_UNIX, kind) as probe:
            try:
                probe.connect(str(path))
            except OSError:
                path.unlink()
            else:
                raise NotReady(f"another twin listens at {path} already; stop it, or use another path")
    listening = socket.socket(socket.AF_UNIX, kind)
    try:
        listening.bind(str(path))
    except OSError as error:
        listening.close()
        raise NotReady(f"cannot listen at {path}: {error.strerror or error}") from None
    listening.listen()
    listening.setblocking(False)
    return listening


@final
class Hub(Source):
    """Accepts clients at `path`; `stamp` turns modelled time [s] into ns on CLOCK_MONOTONIC."""

    def __init__(self, bus: Bus, reactor: Reactor, path: Path, stamp: Callable[[float], int]) -> None:
        self.bus, self.reactor, self.path, self._stamp = bus, reactor, path, stamp
        self.clients: list[Client] = []
        self._made = 0
        self._socket = listen(path, socket.SOCK_SEQPACKET)
        reactor.add(self)

    def fileno(self) -> int:
        """Of the listening socket."""
        return self._socket.fileno()

    def ready(self) -> None:
        """Somebody connects: a station on the bus, called host 1, 2, …"""
        connection, _ = self._socket.accept()
        connection.setblocking(False)
        self._made += 1
        client = Client(self, connection, f"host {self._made}", self._stamp)
        self.clients.append(client)
        self.reactor.add(client)

    def close(self) -> None:
        """All clients are cut off, the path is removed."""
        for client in tuple(self.clients):
            client.close()
        self._socket.close()
        self.path.unlink(missing_ok=True)


@final
class Client(Source):
    """One connection: what it sends waits for the bus, what passes on the bus goes to it while it reads."""

    def __init__(self, hub: Hub, connection: socket.socket, name: str, stamp: Callable[[float], int]) -> None:
        self._hub, self._socket, self._stamp = hub, connection, stamp
        self.port = hub.bus.attach(name, self._deliver)
        self.overflown = 0  # frames it was too slow for
        self.malformed = 0  # packets that were no frames

    def fileno(self) -> int:
        """Of the client's socket."""
        return self._socket.fileno()

    def wants(self) -> bool:
        """Whether its station has room for a frame: else the client waits in its own socket."""
        return self.port.has_room

    def ready(self) -> None:
        """Frames received go to the bus as long as there is room; what is no frame is counted in `malformed`."""
        while self.wants():
            try:
                packet = self._socket.recv(PACKET.size + 1)
            except BlockingIOError:
                return
            except OSError:
                packet = b""
            if not packet:
                self.close()
                return
            if len(packet) != PACKET.size:
                self.malformed += 1
                continue
            identifier, size, data, _ = PACKET.unpack(packet)
            self.port.send(Frame(identifier, data[: min(size, 8)]))

    def _deliver(self, frame: Frame, t: float) -> None:
        identifier, data = frame
        payload = b"" if identifier & REMOTE else data
        try:
            self._socket.send(PACKET.pack(identifier, len(data), payload, self._stamp(t)))
        except BlockingIOError:
            self.overflown += 1
        except OSError:
            self._hub.bus.agenda.after(0.0, self.close)

    def close(self) -> None:
        """Gone, and its station with it. Idempotent."""
        if self in self._hub.clients:
            self._hub.clients.remove(self)
            self._hub.reactor.remove(self)
            self.port.leave()
            self._socket.close()
