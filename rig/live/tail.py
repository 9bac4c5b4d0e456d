"""The rows of a run as they come, for whoever shows them: a reader that never makes anybody wait."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rig.core.ring import Ring
from rig.runfile.process import started


class Tail:
    """The end of a run's ring, read-only. What it was too slow for is left out and counted, never waited for."""

    def __init__(self, path: Path) -> None:
        """Begins with the oldest row that is still there. Raises RecorderError when `path` is not a ring."""
        self._ring = Ring.attach(path)
        self._at = self._ring.oldest  # the next row to read, counted from the first ever put
        self.skipped = 0  # rows that were overwritten before they were read

    @property
    def columns(self) -> list[str]:
        """The names of the channels, in the order of the fields of a row."""
        return [name for name, _ in self._ring.columns]

    @property
    def waiting(self) -> int:
        """Rows that `read` would look at now."""
        return self._ring.head - self._at

    @property
    def closed(self) -> bool:
        """True when no row will follow: the producer has finished, or has died.

        Ask before the last `read`: what was put before the answer is then in what is read after it.
        """
        return self._ring.closed or self._orphaned()

    def read(self, most: int | None = None) -> np.ndarray[Any, Any]:
        """Rows since the last call, copied; shape (n,), a float64 or int64 field per channel of `rig.core.channels`.

        `most` bounds n, the newest rows being those kept; the others count as skipped. Without it n is bounded by the
        ring's capacity.
        """
        stop = self._ring.head
        start = self._at if most is None else max(self._at, stop - most)
        rows = self._ring.read(start, stop)
        self.skipped += stop - self._at - len(rows)
        self._at = stop
        return rows

    def close(self) -> None:
        """Let go of the memory. Idempotent; nothing can be read after."""
        self._ring.close()

    def _orphaned(self) -> bool:
        """A producer that says when it started, and of which there is no such process any more."""
        since = self._ring.producer_started
        return bool(since) and started(self._ring.producer_pid) != since
