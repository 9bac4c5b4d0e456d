"""Output that may vanish (a closed terminal, `| head`, a full disk) must not decide how a run ends."""

from __future__ import annotations

import contextlib
import errno
import os
from typing import Any, TextIO

from rig.process.plain import NAME

NOBODY = (errno.EPIPE, errno.EIO)  # `| head`, a closed terminal: who read here chose not to, and nothing is missed


def standard(stream: TextIO | None, number: int) -> TextIO:
    """`stream`, the process's standard stream `number`; where it was closed (`2>&-`) one that goes nowhere, in its
    place: else the next file opened would get that number, and what a library says there would stand in it."""
    if stream is not None:
        return stream
    try:
        os.fstat(number)
    except OSError:
        nowhere = os.open(os.devnull, os.O_RDWR)
        os.dup2(nowhere, number)  # processes of ours inherit it
        if nowhere != number:
            os.close(nowhere)
        os.set_inheritable(number, True)
        return open(number, "w", closefd=False)
    return open(os.devnull, "w")  # the number is somebody else's by now


class Tolerant:
    """A text stream that goes silent for good at the first write that fails. Everything else is the stream's own."""

    def __init__(self, stream: TextIO | None) -> None:
        self._stream = stream
        self._own = stream  # its encoding and the like are asked for after it fell silent, too
        self.lost = ""  # why output that somebody wanted is not there, in the system's words

    def write(self, text: str) -> int:
        """As `TextIO.write`; never raises."""
        return self._try("write", text) or 0

    def flush(self) -> None:
        """As `TextIO.flush`; never raises."""
        self._try("flush")

    def _try(self, what: str, *args: str) -> Any:
        if self._stream is None:
            return None
        try:
            return getattr(self._stream, what)(*args)
        except (OSError, ValueError) as why:
            if isinstance(why, OSError) and why.errno not in NOBODY:
                self.lost = why.strerror or str(why)
            self._silence(self._stream)
            self._stream = None
            return None

    @staticmethod
    def _silence(stream: TextIO) -> None:
        """What is still buffered would be tried again when Python ends: let it go nowhere."""
        try:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, stream.fileno())
            os.close(nowhere)
        except (OSError, ValueError):
            return

    def isatty(self) -> bool:
        """False once it is silent."""
        return self._stream is not None and self._stream.isatty()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._own, name)


def show_what_fits(stream: TextIO | None) -> None:
    """From here on a character that the encoding of `stream` lacks is written in others, and fails no line."""
    reconfigure = getattr(stream, "reconfigure", None)
    if reconfigure is not None:
        with contextlib.suppress(OSError, ValueError):  # closed, or text is half written
            reconfigure(errors=NAME)
