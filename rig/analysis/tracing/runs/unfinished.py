"""Whether a campaign that hdrig makes is over: a verdict on two of seven planned runs says so first."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from rig.core.errors import NotReady
from rig.runfile.process import is_being_made

BOOK: Final = "campaign.json"
OVER: Final = "completed"


def refuse_going_on(folder: Path) -> None:
    """Raises NotReady while another process makes the campaign: what is missing in it may be measured in an hour."""
    book = _book(folder)
    process = book.get("process")
    if is_being_made(book) and isinstance(process, dict) and process.get("pid") != os.getpid():
        raise NotReady(
            f"{folder} is still being made by process {process.get('pid')}: {_done(book)}; trace it when it is over"
        )


def unfinished(folder: Path) -> str:
    """How much of the plan is there, as a sentence; "" where it is over, or nobody planned anything."""
    book = _book(folder)
    if not book.get("runs") or book.get("status") == OVER:
        return ""
    return (
        f"The campaign is not over: {_done(book)}. What the others would show is not known; hdrig campaign --resume "
        "takes it up."
    )


def _done(book: Mapping[str, Any]) -> str:
    runs = [entry for entry in book.get("runs", []) if isinstance(entry, dict)]
    done = sum(entry.get("status") == "done" for entry in runs)
    return f"{done} of its {len(runs)} planned runs {'is' if done == 1 else 'are'} done"


def _book(folder: Path) -> dict[str, Any]:
    """campaign.json as it lies there; {} where there is none, or one that is none of ours."""
    try:
        found = json.loads((folder / BOOK).read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) and isinstance(found.get("runs"), list) else {}
