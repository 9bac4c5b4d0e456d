"""A terminal and a person's fingers, for tests."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Callable
from pathlib import Path

HDRIG = [sys.executable, "-m", "rig.cli"]
LONGEST = 60.0  # s until a test gives up


class Terminal:
    """A program on a pseudo-terminal of its own, its controlling one, as under a shell."""

    def __init__(self, arguments: list[str], *, program: list[str] = HDRIG, json: Path | None = None) -> None:
        self.ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 100, 0, 0))
        self.theirs = theirs
        self.before = termios.tcgetattr(theirs)
        out = open(json, "wb") if json else theirs  # noqa: SIM115 - closed with the process
        self.process = subprocess.Popen(
            [*program, *arguments],
            stdin=theirs,
            stdout=out,
            stderr=theirs,
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
        )
        self.seen = ""

    def press(self, keys: str) -> None:
        """As typed."""
        os.write(self.ours, keys.encode())

    def wait_for(self, what: Callable[[str], bool]) -> None:
        """Until the screen has shown it, or the program has ended."""
        give_up = time.monotonic() + LONGEST
        while not what(self.seen):
            assert time.monotonic() < give_up, self.seen[-2000:]
            self._look()

    def end(self) -> int:
        """The exit code; everything was read."""
        give_up = time.monotonic() + LONGEST
        while self.process.poll() is None:
            assert time.monotonic() < give_up, self.seen[-2000:]
            self._look()
        while select.select([self.ours], [], [], 0.05)[0]:
            self._look()
        return self.process.returncode

    def _look(self) -> None:
        if select.select([self.ours], [], [], 0.1)[0]:
            self.seen += os.read(self.ours, 65536).decode(errors="replace")

    @property
    def modes(self) -> list[object]:
        """Of the terminal, now."""
        return termios.tcgetattr(self.theirs)

    def close(self) -> None:
        """No process and no file stays."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        os.close(self.ours)
        os.close(self.theirs)
