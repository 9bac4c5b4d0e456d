"""The bus over TCP as socketcand serves it in raw mode: `< send 123 2 11 22 >`, `< frame 123 12.345678 1122 >`"""

from __future__ import annotations

import re
import socket
from typing import final

from rig.core.errors import NotReady, UsageError
from sim.wire.bus import Bus
from sim.wire.frame import ERROR, EXTENDED, REMOTE, Frame
from sim.wire.reactor import Reactor, Source

MESSAGE = re.compile(rb"<\s*([^<>]*?)\s*>")
LONGEST = 4096  # bytes without a message among them


@final
class SocketCand(Source):
    """Listens at `port` on this machine only; 0 takes a free one. Raises NotReady when it is taken,
    UsageError when there is no such port."""

    def __init__(self, bus: Bus, reactor: Reactor, port: int) -> None:
        self.bus, self.reactor = bus, reactor
        self.guests: list[Guest] = []
        self._socket = socket.socket()
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self._socket.bind(("127.0.0.1", port))
        except OverflowError:
            self._socket.close()
            raise UsageError(f"socketcand at port {port}: ports go from 0, a free one, to 65535") from None
        except OSError as error:
            self._socket.close()
            raise NotReady(f"cannot serve socketcand at port {port}: {error.strerror}") from None
        self._socket.listen()
        self.port = self._socket.getsockname()[1]
        reactor.add(self)

    def fileno(self) -> int:
        """Of the listening socket."""
        return self._socket.fileno()

    def ready(self) -> None:
        """Somebody connects: a Guest, greeted."""
        guest = Guest(self, self._socket.accept()[0])
        self.guests.append(guest)
        self.reactor.add(guest)

    def close(self) -> None:
        """All guests are cut off."""
        for guest in tuple(self.guests):
            guest.close()
        self._socket.close()


@final
class Guest(Source):
    """One client: greeted, then `open`, then `rawmode`, then frames."""

    def __init__(self, server: SocketCand, connection: socket.socket) -> None:
        self._server, self._socket = server, connection
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setblocking(False)
        self._text = b""
        self._raw = False
        self.overflown = 0
        self.station = server.bus.attach("socketcand", self._deliver)
        self._say(b"< hi >")

    def fileno(self) -> int:
        """Of the guest's socket."""
        return self._socket.fileno()

    def wants(self) -> bool:
        """Whether its station has room for a frame."""
        return self.station.has_room

    def ready(self) -> None:
        """Every whole message received is performed and answered."""
        try:
            got = self._socket.recv(LONGEST)
        except OSError:
            got = b""
        if not got:
            self.close()
            return
        self._text += got
        end = 0
        for message in MESSAGE.finditer(self._text):
            self._perform(message[1].split())
            end = message.end()
        self._text = self._text[end:][-LONGEST:]

    def _perform(self, words: list[bytes]) -> None:
        match words:
            case [b"open", _]:
                self._say(b"< ok >")
            case [b"rawmode"]:
                self._raw = True
                self._say(b"< ok >")
            case [b"echo"]:
                self._say(b"< echo >")
            case [b"send", identifier, size, *data]:
                self._send(identifier, size, data)
            case _:
                self._say(b"< error unknown command >")

    def _send(self, identifier: bytes, size: bytes, data: list[bytes]) -> None:
        try:
            number, payload = int(identifier, 16), bytes(int(byte, 16) for byte in data)
            if int(size, 16) != len(payload) or len(payload) > 8:
                raise ValueError(size)
        except ValueError:
            self._say(b"< error could not parse message >")
            return
        self.station.send(Frame(number | (EXTENDED if len(identifier) == 8 else 0), payload))

    def _deliver(self, frame: Frame, t: float) -> None:
        if self._raw and not frame.identifier & (REMOTE | ERROR):  # raw mode has no word for those
            number = frame.identifier & (ERROR - 1)
            name = b"%08X" % number if frame.identifier & EXTENDED else b"%03X" % number
            self._say(b"< frame %s %.6f %s >" % (name, t, frame.data.hex().upper().encode("ascii")))

    def _say(self, text: bytes) -> None:
        try:
            self._socket.send(text)
        except BlockingIOError:
            self.overflown += 1
        except OSError:
            self._server.bus.agenda.after(0.0, self.close)

    def close(self) -> None:
        """Gone, and its station with it. Idempotent."""
        if self in self._server.guests:
            self._server.guests.remove(self)
            self._server.reactor.remove(self)
            self.station.leave()
            self._socket.close()
