"""`events.jsonl`: what happened in a run and when; one line an event, safe from a kill when `write` returns."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

from rig.core.errors import DataError, RecorderError
from rig.core.regular import regular
from rig.runfile.manifest import parse, told, utc_now, write_atomic

NAME = "events.jsonl"
LONGEST_LINE = 2**20  # bytes; an event of ours is a sentence, and a line of 200 MB takes minutes to parse


class EventLog:
    """Appends to the events of one run. A context manager; `utc` gives the time written beside each event."""

    def __init__(self, folder: Path, utc: Callable[[], str] = utc_now) -> None:
        """Raises RecorderError when the file cannot be opened."""
        self.path = folder / NAME
        self._utc = utc
        with told(RecorderError, f"events of the run cannot be written to {self.path}"):
            self._file = open(self.path, "ab", buffering=0)  # noqa: SIM115 - closed by `close`

    def write(self, kind: str, text: str, t: float | None = None, **more: Any) -> None:
        """One event. `kind` is state, trip, operator, note …; `t` is run time [s] if known. Raises RecorderError."""
        self.append(self.line(kind, text, t, **more))

    def line(self, kind: str, text: str, t: float | None = None, **more: Any) -> bytes:
        """An event as it is written, with the time of now beside it."""
        event = {"t": t, "utc": self._utc(), "kind": kind, "text": text, **more}
        return json.dumps(event, ensure_ascii=False).encode(errors="replace") + b"\n"

    def append(self, line: bytes) -> None:
        """One line of events. Raises RecorderError."""
        with told(RecorderError, f"events of the run cannot be written to {self.path}"):
            self._file.write(line)

    def forsake(self) -> None:
        """A copy takes the place of the file: whoever is held up in writing to it adds nothing to what is read and
        hashed from now on. Raises RecorderError.
        """
        with told(RecorderError, f"events of the run cannot be written to {self.path}"):
            write_atomic(self.path, self.path.read_bytes())

    def close(self) -> None:
        """Idempotent."""
        self._file.close()

    def __enter__(self) -> EventLog:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()


def read_events(folder: Path) -> list[dict[str, Any]]:
    """The events of a run in order; none where there is no file. A line torn by a kill is left out, as is what is none.

    Raises DataError when it is no file, or cannot be read.
    """
    path = folder / NAME
    try:
        regular(path)
        lines = path.read_bytes().split(b"\n")
    except FileNotFoundError:
        return []
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}") from error
    found = []
    for line in (line for line in lines if len(line) <= LONGEST_LINE):
        try:
            event = parse(line)
        except ValueError:
            continue
        if isinstance(event, dict):
            found.append(event)
    return found


def mend_events(folder: Path) -> None:
    """Give a line torn by a kill its end, so that the next event begins a line of its own. Raises OSError."""
    path = folder / NAME
    if path.exists() and not path.read_bytes().endswith(b"\n") and path.stat().st_size:
        with open(path, "ab") as file:
            file.write(b"\n")
