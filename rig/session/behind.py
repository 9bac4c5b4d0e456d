"""Events of a run into its folder, written behind the loop's back: a disk that hangs holds up a thread that has nothing
else to do, and not the one that turns the motor and may be about to stop it.
"""

from __future__ import annotations

import contextlib
import queue
import threading
from typing import Final

from rig.core.errors import HdrigError
from rig.runfile.events import EventLog

PATIENCE: Final = 10.0  # s for the last lines to be written when the run is closed


class Behind:
    """Writes to a log in the order in which it was told. Made before a run is energised: its thread is not one that
    real-time scheduling is asked for."""

    def __init__(self, log: EventLog) -> None:
        self._log = log
        self._lines: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._write, name="events", daemon=True)
        self._thread.start()

    def write(self, kind: str, text: str, t: float | None) -> None:
        """One event, with the time of now. Never waits, never raises."""
        self._lines.put(self._log.line(kind, text, t))

    def _write(self) -> None:
        while (line := self._lines.get()) is not None:
            with contextlib.suppress(HdrigError):  # a full disk shows in the rows
                self._log.append(line)
        self._log.close()

    def close(self) -> bool:
        """No event comes any more; whether all are written. A thread that the disk still holds up is left to it, and
        writes to what is read no more. Raises RecorderError.
        """
        self._lines.put(None)
        self._thread.join(PATIENCE)
        if self._thread.is_alive():
            self._log.forsake()
            return False
        return True
