"""Output that may vanish (a closed terminal, `| head`, a full disk) must not decide how a run ends."""

from __future__ import annotations

import os
from typing import Any, TextIO


class Tolerant:
    """A text stream that goes silent for good at the first write that fails. Everything else is the stream's own."""

    def __init__(self, stream: TextIO | None) -> None:
        self._stream = stream
        self._own = stream  # its encoding and the like are asked for after it fell silent, too

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
        except (OSError, ValueError):
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
