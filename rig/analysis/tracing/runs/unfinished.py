"""Whether a campaign that hdrig makes is over and whole: a verdict on two of seven planned runs says so first."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sized
from pathlib import Path
from typing import Any, Final

from rig.core.errors import NotReady
from rig.core.few import few
from rig.runfile.planned import done_runs
from rig.runfile.process import is_being_made

BOOK: Final = "campaign.json"
OVER: Final = "completed"
DONE: Final = "done"  # of a run of it
NAMED: Final = 3  # of the runs that are gone
TAKEN_UP: Final = "hdrig campaign --resume takes it up"


def refuse_going_on(folder: Path) -> None:
    """Raises NotReady while another process makes the campaign: what is missing in it may be measured in an hour."""
    book = _book(folder)
    process = book.get("process")
    if is_being_made(book) and isinstance(process, dict) and process.get("pid") != os.getpid():
        raise NotReady(
            f"{folder} is still being made by process {process.get('pid')}: {_done(book)}; trace it when it is over"
        )


def unfinished(folder: Path) -> str:
    """How much of the plan is there, in sentences; "" where all of it is, or nobody planned anything."""
    book = _book(folder)
    said = []
    if book.get("status") != OVER and any(run.get("status") != DONE for run in _entries(book)):
        said.append(f"The campaign is not over: {_done(book)}.")
    if gone := [run.name for run in done_runs(folder, book) if run.folder is None]:
        said.append(f"Of the runs that {BOOK} calls done {len(gone)} {_is(gone)} not there: {few(gone, NAMED)}.")
    return f"{' '.join(said)} What the others would show is not known; {TAKEN_UP}." if said else ""


def _is(some: Sized) -> str:
    return "is" if len(some) == 1 else "are"


def _done(book: Mapping[str, Any]) -> str:
    runs = _entries(book)
    done = [entry for entry in runs if entry.get("status") == DONE]
    return f"{len(done)} of its {len(runs)} planned runs {_is(done)} done"


def _entries(book: Mapping[str, Any]) -> list[dict[str, Any]]:
    return [entry for entry in book.get("runs", []) if isinstance(entry, dict)]


def _book(folder: Path) -> dict[str, Any]:
    """campaign.json as it lies there; {} where there is none, or one that is none of ours."""
    try:
        found = json.loads((folder / BOOK).read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) and isinstance(found.get("runs"), list) else {}
