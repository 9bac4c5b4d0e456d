"""The runs below the console's folder: lists, comparison, trends, reports. Reads files, writes none."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Request
from fastapi.responses import FileResponse, JSONResponse
from starlette.responses import Response

from rig.catalogue import Row, compare, runs, trend
from rig.catalogue.filter import asked
from rig.core.errors import HdrigError, UsageError

REPORT = "report.html"
SHOWN = (REPORT, "summary.txt", "trace.html")  # what a browser is given of a folder
WORDS = ("gear", "procedure", "verdict", "status", "since", "until", "sort")


def add_runs(app: FastAPI, root: Path) -> None:
    """The routes about runs that were made."""

    @app.get("/api/runs")
    async def listed(request: Request) -> Response:
        words = {name: request.query_params.get(name, "") for name in WORDS}
        newest_first = request.query_params.get("reverse", "true") != "false"
        return await _answer(
            lambda: {"runs": [_row(row, root) for row in runs(root, asked(**words, reverse=newest_first))]}
        )

    @app.get("/api/runs/{uid}")
    async def one(uid: str) -> Response:
        return await _answer(lambda: _row(_by_uid(root, uid), root))

    @app.get("/api/compare")
    async def compared(request: Request) -> Response:
        paths = request.query_params.getlist("run")
        return await _answer(lambda: compare([_ours(root, path) for path in paths], root).as_json())

    @app.get("/api/trends")
    async def trends(figure: str = "peak-to-peak", gear: str = "") -> Response:
        return await _answer(lambda: trend(root, figure, gear).as_json())

    @app.get("/runs/{path:path}")
    async def report(path: str) -> Response:
        found = inside(root, path)
        if found is None or found.name not in SHOWN or not found.is_file():
            return JSONResponse({"why": f"there is no report at '{path[:200]}'"}, 404)
        return FileResponse(found)


async def _answer(work: Callable[[], dict[str, Any]]) -> Response:
    """Done aside, so that thousands of manifests keep no halt waiting; a refusal is a sentence."""
    try:
        return JSONResponse(await asyncio.to_thread(work))
    except HdrigError as error:
        return JSONResponse({"why": str(error)}, 400)


def inside(root: Path, path: str) -> Path | None:
    """What `path` names below `root`, links followed; None for anything outside."""
    try:
        found, base = (root / path).resolve(), root.resolve()
    except (OSError, ValueError, RuntimeError):  # ValueError: a zero byte; RuntimeError: links in a ring
        return None
    return found if found.is_relative_to(base) else None


def report_of(root: Path, folder: Path) -> str | None:
    """Where a browser finds the report of a run; None when there is none."""
    found = inside(root, str(folder.absolute() / REPORT))
    if found is None or not found.is_file():
        return None
    return f"/runs/{found.relative_to(root.resolve()).as_posix()}"


def _ours(root: Path, path: str) -> Path:
    found = inside(root, str(Path(path).absolute()))
    if found is None:
        raise UsageError(f"{path[:200]} is not in {root}")
    return found


def _by_uid(root: Path, uid: str) -> Row:
    found = next((row for row in runs(root) if row.uid == uid), None)
    if found is None:
        raise UsageError(f"no run in {root} has the uid '{uid[:64]}'")
    return found


def _row(row: Row, root: Path) -> dict[str, Any]:
    return {**row.as_json(), "report": report_of(root, row.path)}
