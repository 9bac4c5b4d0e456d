"""What was read from a file, kept while the file is the same. Held in memory alone: nothing on disk can go stale."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")
FRESH = 2_000_000_000  # ns; a file this young may change again without its time showing it (FAT counts in 2 s)


class Remembered(Generic[T]):
    """`read(path)`, called again only when time of change, size or inode of the file are others.

    The time is that of the inode, which no program can set back as it can the time of the contents.

    Safe to use from several threads: two that meet both read, and either answer is right.
    """

    def __init__(self, read: Callable[[str], T]) -> None:
        self._read = read
        self._kept: dict[str, tuple[tuple[int, int, int], T]] = {}

    def __call__(self, path: str) -> T:
        """What `read` gives for `path` as it is now; raises what it raises."""
        try:
            about = os.stat(path)
        except OSError:
            self._kept.pop(path, None)
            return self._read(path)
        now = (about.st_ctime_ns, about.st_size, about.st_ino)
        kept = self._kept.get(path)
        if kept is not None and kept[0] == now:
            return kept[1]
        value = self._read(path)
        if time.time_ns() - about.st_ctime_ns > FRESH:
            self._kept[path] = (now, value)
        return value
