"""A serial line that ends at a pty: bytes take the time their baud rate asks for; a wrong baud rate makes rubbish."""

from __future__ import annotations

import os
import pty
import termios
import tty
from abc import ABC, abstractmethod
from pathlib import Path
from typing import final

from rig.core.errors import UsageError
from sim.wire.agenda import Agenda
from sim.wire.reactor import Reactor, Source

BITS = 10  # of a byte: start, eight, stop
CHUNK = 4096
SPEEDS = {getattr(termios, name): int(name[1:]) for name in dir(termios) if name[0] == "B" and name[1:].isdigit()}


class LineDevice(ABC):
    """What is at the other end."""

    line: SerialLine

    @abstractmethod
    def receive(self, data: bytes) -> None:
        """Bytes from the host, cut anywhere."""

    def wants(self) -> bool:
        """Whether it can take more now."""
        return True

    @abstractmethod
    def plugged(self) -> None:
        """Power is there: start from the beginning."""


class Spoiler:
    """Something wrong with the line; the base class is a sound one."""

    def spoil(self, data: bytes) -> list[tuple[float, bytes]]:
        """What arrives in place of `data`: (s later, bytes) for each."""
        return [(0.0, data)]

    @property
    def sound(self) -> bool:
        """Whether nothing is wrong, or no longer."""
        return type(self) is Spoiler


@final
class SerialLine(Source):
    """`path` is a symbolic link to the pty, as /dev/serial/by-id has them; it goes and comes with the plug. Raises
    UsageError where something else has that name."""

    def __init__(self, agenda: Agenda, reactor: Reactor, path: Path, device: LineDevice, baud: float) -> None:
        self.agenda, self.reactor, self.path, self.device, self.baud = agenda, reactor, path, device, baud
        self.spoiler = Spoiler()
        self.latency = 0.0  # s, an adapter holds what it has until its timer of this period runs out
        self.lost = 0  # bytes nobody read
        self.present = False
        self._free_at = 0.0  # s
        device.line = self
        if os.path.lexists(path) and not path.is_symlink():
            raise UsageError(f"{path} is not a link of an earlier twin; it stays as it is: give a name that is free")
        self.plug()

    def fileno(self) -> int:
        return self._master

    def wants(self) -> bool:
        return self.device.wants()

    def plug(self) -> None:
        """There it is, under a new pty and the same link."""
        if self.present:
            return
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(os.ttyname(self._slave))
        self.present = True
        self.reactor.add(self)
        self.device.plugged()

    def unplug(self) -> None:
        """The plug is pulled: who has it open gets an error."""
        if not self.present:
            return
        self.present = False
        self.reactor.remove(self)
        self.path.unlink(missing_ok=True)
        os.close(self._slave)
        os.close(self._master)

    def close(self) -> None:
        self.unplug()

    def ready(self) -> None:
        try:
            data = os.read(self._master, CHUNK)
        except OSError:
            return
        self.device.receive(data)

    def send(self, data: bytes) -> None:
        """Bytes from the device; they arrive when the last of them has passed."""
        for delay, part in self.spoiler.spoil(data):
            self._free_at = max(self._free_at, self.agenda.now) + len(part) * BITS / self.baud
            due = self._free_at + delay
            if self.latency > 0.0:
                due = (due // self.latency + 1.0) * self.latency
            self.agenda.at(due, lambda bytes_=part: self._arrive(bytes_))  # type: ignore[misc]

    def _arrive(self, data: bytes) -> None:
        if not self.present:
            return
        try:
            written = os.write(self._master, data if self._same_baud() else rubbish(data))
        except BlockingIOError:
            written = 0
        self.lost += len(data) - written

    def _same_baud(self) -> bool:
        """Whether the host has set our rate; a device without one does not mind."""
        theirs = SPEEDS.get(termios.tcgetattr(self._slave)[5], 0)
        return self.baud == float("inf") or theirs == self.baud


def rubbish(data: bytes) -> bytes:
    """What a receiver at another baud rate makes of `data`: about as many bytes, none of them right."""
    return bytes((byte * 29 + 0x85) & 0xFF | 0x80 for byte in data)
