"""The campaigns below the console's folder that were left before their end: what can be gone on with."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fastapi import FastAPI
from fastapi.responses import JSONResponse
from starlette.responses import Response

from rig.campaign import journal
from rig.console.runs import inside
from rig.core.errors import HdrigError, UsageError
from rig.runfile.process import is_being_made

DEAD = "it was killed"


def add_campaigns(app: FastAPI, root: Path) -> None:
    """The one route about campaigns."""

    @app.get("/api/campaigns")
    async def listed() -> Response:
        return JSONResponse({"campaigns": await asyncio.to_thread(lambda: list(unfinished(root)))})


def unfinished(root: Path) -> Iterator[dict[str, Any]]:
    """Newest first; those that another process makes, and those that cannot be read, are left out."""
    names = sorted((one.name for one in os.scandir(root) if one.is_dir()), reverse=True) if root.is_dir() else []
    for folder in (root / name for name in names if (root / name / journal.NAME).is_file()):
        try:
            found = journal.read_journal(folder)
            if found.open_runs() and not is_being_made(found.book):
                yield told(found)
        except (HdrigError, KeyError, TypeError, AttributeError):  # a book of somebody else's making
            continue


def told(found: journal.Journal) -> dict[str, Any]:
    """As a page shows it."""
    book, total = found.book, len(found.book["runs"])
    return {
        "folder": str(found.folder), "plan": book["name"], "bench": book["bench"]["source"],
        "started_utc": book["started_utc"], "done": total - len(found.open_runs()), "total": total,
        "why": book["sentence"] or DEAD,
    }  # fmt: skip


def ours(root: Path, folder: object) -> Path:
    """The campaign a page named. Raises UsageError for one that is not below `root`."""
    found = inside(root, str(Path(str(folder)).absolute())) if folder else None
    if found is None:
        raise UsageError(f"{str(folder)[:200]} is not in {root}: a campaign is gone on with where its runs are")
    return found
