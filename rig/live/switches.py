"""Hold, stop and halt as counters in a page of shared memory: pressing one waits behind nothing, nor does seeing it.
What the loop counts of its own lateness goes the other way: telling it is a store and wakes nobody.

A plain file in /dev/shm, mapped by two processes. Whoever serves the page presses (one process, one thread); the
station looks at every tick and says what it has seen. Every counter is one aligned 8-byte store, as in `rig.core.ring`.
"""

from __future__ import annotations

import mmap
import os
import struct
import tempfile
import time
from pathlib import Path
from typing import NamedTuple, final

from rig.core.errors import NotReady
from rig.core.ring import SHARED

SIZE = 4096  # bytes: one page
_MAGIC, _VERSION = b"hdrigSWI", 1
_FIXED = struct.Struct("<8sI")
_PRESSED = slice(64, 128)  # stored by whoever serves the page: a cache line of its own
_SEEN = slice(128, 192)  # stored by the station
_COUNTED = slice(192, 256)  # stored by the station: what its loop counts
_PAGE = 3  # of _PRESSED: when a page gave its last sign of life


class Counts(NamedTuple):
    """How often each was pressed, or seen to be, since the page was made."""

    hold: int = 0
    stop: int = 0
    halt: int = 0


class Counted(NamedTuple):
    """What the loop of the present run counts."""

    ticks: int = 0
    missed: int = 0  # cycles
    p50_us: int = 0  # lateness of a tick, median; 0 before it was looked at
    p99_us: int = 0


@final
class Switches:
    """`Switches.create` for whoever presses, `Switches.attach` for the station."""

    def __init__(self, path: Path, mapped: mmap.mmap) -> None:
        self.path = path
        self._mapped = mapped
        self._view = memoryview(mapped)
        self._pressed = self._view[_PRESSED].cast("Q")
        self._seen = self._view[_SEEN].cast("Q")
        self._counted = self._view[_COUNTED].cast("Q")

    @classmethod
    def create(cls) -> Switches:
        """A new page of switches, none pressed; a page is taken as seen now. Raises NotReady without shared memory."""
        folder = SHARED if os.path.isdir(SHARED) else tempfile.gettempdir()
        try:
            handle, name = tempfile.mkstemp(prefix="hdrig-", suffix=".switches", dir=folder)
            with open(handle, "r+b") as file:
                file.write(_FIXED.pack(_MAGIC, _VERSION).ljust(SIZE, b"\0"))
                file.flush()
                made = cls(Path(name), mmap.mmap(file.fileno(), SIZE))
        except OSError as error:
            raise NotReady(f"no room for a page of shared memory in {folder}: {error.strerror}") from None
        made.page_alive()
        return made

    @classmethod
    def attach(cls, path: Path) -> Switches:
        """Those another process made. Raises NotReady when `path` is no page of switches."""
        try:
            with open(path, "r+b") as file:
                mapped = mmap.mmap(file.fileno(), SIZE)
        except (OSError, ValueError) as error:  # ValueError: a file that is shorter
            raise NotReady(f"{path} is no page of switches: {error}") from None
        if _FIXED.unpack_from(mapped) != (_MAGIC, _VERSION):
            raise NotReady(f"{path} is no page of switches: it does not begin as one of version {_VERSION}")
        return cls(path, mapped)

    def hold(self) -> None:
        """Press hold (category 2)."""
        self._pressed[0] += 1

    def stop(self) -> None:
        """Press stop (category 1)."""
        self._pressed[1] += 1

    def halt(self) -> None:
        """Press halt (category 0)."""
        self._pressed[2] += 1

    def page_alive(self) -> None:
        """A page gave a sign of life."""
        self._pressed[_PAGE] = time.monotonic_ns()

    @property
    def pressed(self) -> Counts:
        """How often each was pressed."""
        return Counts(self._pressed[0], self._pressed[1], self._pressed[2])

    @property
    def total(self) -> int:
        """How often any was pressed: when it is the same as before, nothing was."""
        return self._pressed[0] + self._pressed[1] + self._pressed[2]

    @property
    def seen(self) -> Counts:
        """How often of that the station has seen."""
        return Counts(self._seen[0], self._seen[1], self._seen[2])

    @property
    def page_age(self) -> float:
        """s since the last sign of life of a page."""
        return (time.monotonic_ns() - self._pressed[_PAGE]) * 1e-9

    def tell_seen(self, counts: Counts) -> None:
        """The station's word: it acts on these."""
        self._seen[0], self._seen[1], self._seen[2] = counts

    @property
    def counted(self) -> Counted:
        """The station's word on its loop's ticks."""
        return Counted(*self._counted[:4])

    def tell_counted(self, counted: Counted) -> None:
        """From within a tick: four stores."""
        self._counted[0], self._counted[1], self._counted[2], self._counted[3] = counted

    def close(self) -> None:
        """Let go of the memory; the file stays. Idempotent."""
        for view in (self._pressed, self._seen, self._counted, self._view):
            view.release()
        self._mapped.close()

    def unlink(self) -> None:
        """Remove the file; whoever has it mapped keeps what is in it."""
        self.path.unlink(missing_ok=True)
