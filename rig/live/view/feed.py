"""A run that is going on, as it comes: rows from its ring, lines from its events; neither is ever waited for."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from rig.core.errors import HdrigError, RecorderError
from rig.core.regular import regular
from rig.live.tail import Tail
from rig.runfile import manifest
from rig.runfile.events import NAME


class EventTail:
    """The lines of `events.jsonl` since the last look; one that is not whole yet is left for the next."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        self._at = 0  # bytes read so far

    def read(self) -> list[dict[str, Any]]:
        """New events; none where there is no file."""
        try:
            regular(self._path)
            with open(self._path, "rb") as file:
                file.seek(self._at)
                new = file.read()
        except OSError:
            return []
        whole = new[: new.rfind(b"\n") + 1]
        self._at += len(whole)
        return [event for line in whole.splitlines() if (event := _event(line))]


class Feed:
    """One run folder. `ready` once there is a ring to read or the run is known to be over."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._events = EventTail(folder)
        self._tail: Tail | None = None
        self._over = False

    @property
    def ready(self) -> bool:
        """True once rows can come. Looks at the manifest while there is no ring yet."""
        if self._tail is None and not self._over:
            self._attach()
        return self._tail is not None

    @property
    def over(self) -> bool:
        """True when no row will follow and every one was read."""
        return self._over

    @property
    def skipped(self) -> int:
        """Rows this reader was too slow for."""
        return self._tail.skipped if self._tail else 0

    def rows(self, most: int) -> np.ndarray[Any, Any]:
        """Rows since the last call, the newest `most` of them; none before `ready`."""
        if self._tail is None:
            return np.empty(0)
        closed = self._tail.closed  # asked before the last rows are read
        rows = self._tail.read(most)
        self._over = closed
        return rows

    def events(self) -> list[dict[str, Any]]:
        """Events since the last call."""
        return self._events.read()

    def close(self) -> None:
        """Let go of the ring. Idempotent."""
        if self._tail is not None:
            self._tail.close()

    def _attach(self) -> None:
        try:
            said = manifest.read(self.folder)
        except HdrigError:  # a manifest that cannot be read yet
            return
        ring = said.get("ring")
        if isinstance(ring, str) and os.path.exists(ring):
            try:
                self._tail = Tail(Path(ring))
            except RecorderError:  # gone or not yet whole: looked at again
                return
        self._over = self._tail is None and said.get("status") != "running"


def _event(line: bytes) -> dict[str, Any] | None:
    try:
        event = manifest.parse(line)
    except ValueError:
        return None
    return event if isinstance(event, dict) else None
