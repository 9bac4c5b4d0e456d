"""One serial port, read without waiting; the three kinds of error an unplugged adapter raises become one sentence."""

from __future__ import annotations

import contextlib
import termios
import time

import serial

from drivers.claim import Claim, claim_port
from drivers.unopened import first_line
from rig.core.errors import NotReady

GONE = (serial.SerialException, OSError, termios.error)  # pyserial 3.5 raises all three for the same pulled plug
UNREAD = 0.5  # s after which what a port has kept is old, and is handed over 4 kB a look, the oldest first
GAP = b"\0"  # part of no line: what came before it and what comes after do not join


class Port:
    """A serial port opened for us alone. RTS and DTR are set before opening: raising them resets some devices."""

    def __init__(self, path: str, baud: int, who: str, rts: bool = True, dtr: bool = True) -> None:
        self.path = path
        self.baud = baud
        self.who = f"{who} on {path}"
        self.dead = ""  # why, in words
        self._made = serial.Serial()
        self._made.port, self._made.baudrate = path, baud
        self._made.timeout, self._made.write_timeout = 0, 0.2  # s; a write to a peer that does not read would block
        self._made.exclusive = True
        self._made.rts, self._made.dtr = rts, dtr
        self._claim: Claim | None = None
        self._read = 0.0  # s, monotonic, when it was read last

    def open(self) -> None:
        """Raises NotReady with the reason."""
        if self._made.is_open:
            return
        try:
            self._claim = claim_port(self.path)
            self._made.open()
            self._made.reset_input_buffer()
        except GONE as why:
            self.close()
            raise NotReady(f"{self.who} could not be opened: {first_line(why)}") from None
        self.dead, self._read = "", time.monotonic()

    def read(self) -> bytes:
        """What has arrived, without waiting; b"" also when the port is gone. Never raises.

        Of a port that nobody read for a while that is thrown away: nobody could tell how old it is.
        """
        if self.dead or not self._made.is_open:
            return b""
        before, self._read = self._read, time.monotonic()
        try:
            if self._read - before > UNREAD:
                self._made.reset_input_buffer()
                return GAP
            waiting = self._made.in_waiting
            return bytes(self._made.read(waiting)) if waiting else b""
        except GONE as why:
            self.dead = f"{self.who} is gone ({why})"
            return b""

    def write(self, data: bytes) -> bool:
        """False when the port is gone or takes nothing. Never raises."""
        if self.dead or not self._made.is_open:
            return False
        try:
            self._made.write(data)
        except GONE as why:
            self.dead = f"{self.who} takes nothing ({why})"
            return False
        return True

    def close(self) -> None:
        """Idempotent; never raises."""
        with contextlib.suppress(*GONE):
            self._made.close()
        if self._claim is not None:
            self._claim.release()
