"""The runs below the console's folder: lists, manifests, reports. Reads files, writes none."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

from fastapi import FastAPI
from fastapi.responses import FileResponse, JSONResponse
from starlette.responses import Response

from rig.core.errors import HdrigError
from rig.runfile.listing import list_runs

SHOWN = ("report.html", "summary.txt", "campaign.html", "trace.html")  # what a browser is given of a folder


def add_runs(app: FastAPI, root: Path) -> None:
    """The routes about runs that were made."""

    @app.get("/api/runs")
    async def runs() -> Response:
        return JSONResponse(await asyncio.to_thread(_listed, root))

    @app.get("/runs/{path:path}")
    async def report(path: str) -> Response:
        found = inside(root, path)
        if found is None:
            return JSONResponse({"why": f"there is no report at '{path[:200]}'"}, 404)
        return FileResponse(found)


def inside(root: Path, path: str) -> Path | None:
    """The file below `root` that `path` names, if it is one a browser is given; nothing outside, links followed."""
    try:
        found, base = (root / path).resolve(), root.resolve()
        if found.name not in SHOWN or not found.is_relative_to(base) or not found.is_file():
            return None
    except (OSError, ValueError):  # ValueError: a zero byte
        return None
    return found


def _listed(root: Path) -> dict[str, Any]:
    try:
        rows = list_runs(root)
    except HdrigError as error:
        return {"runs": [], "why": str(error)}
    found = [{**row._asdict(), "path": str(row.path), "folder": row.path.relative_to(root).as_posix()} for row in rows]
    return {"runs": found[::-1]}
