"""The runs under a root, newest last, from their manifests alone: thousands in a second."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from rig.core.errors import UsageError
from rig.runfile.manifest import NAME, SCHEMA, parse
from rig.runfile.process import is_being_made


class Row(NamedTuple):
    """One run in a list. What is not known is "" or None."""

    started_utc: str  # ISO 8601
    procedure: str
    gear: str  # serial
    status: str  # of the manifest; "interrupted" for one found dead, "unreadable" for a damaged manifest
    duration: float | None  # s of samples
    rows: int | None
    simulated: bool
    verdict: str
    path: Path


def list_runs(root: Path | str) -> list[Row]:
    """Every run under `root`, in folders by date or side by side, oldest first. Raises UsageError without a root."""
    if not Path(root).is_dir():
        raise UsageError(f"there is no folder {root}")
    return sorted((_row(path) for path in run_folders(str(root))), key=lambda row: (row.started_utc, row.path.name))


def run_folders(root: str, depth: int = 3) -> Iterator[str]:
    """Folders with a manifest, down to ./runs/date/run; hidden ones are passed by."""
    try:
        entries = os.scandir(root)
    except OSError:  # not ours to look into
        return
    with entries:
        folders = [e.path for e in entries if e.is_dir() and not e.name.startswith(".")]
    for folder in folders:
        if os.path.exists(f"{folder}/{NAME}"):
            yield folder
        elif depth > 1:
            yield from run_folders(folder, depth - 1)


def _text(value: object) -> str:
    """A word of the manifest; a number is one too (a serial), anything else is as good as nothing said."""
    return str(value) if isinstance(value, str | int | float) else ""


def _number(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)


def _row(folder: str) -> Row:
    try:
        with open(f"{folder}/{NAME}", "rb") as file:
            about = parse(file.read())
        if about["schema"] != SCHEMA:
            raise ValueError
        return _row_of(Path(folder), about)
    except (OSError, ValueError, KeyError, TypeError, OverflowError):
        return Row("", "", "", "unreadable", None, None, False, "", Path(folder))


def _row_of(folder: Path, about: Mapping[str, Any]) -> Row:
    status, gear = _text(about.get("status")), about.get("gear")
    if status == "running" and not is_being_made(about):
        status = "interrupted"
    return Row(
        started_utc=_text(about.get("started_utc")),
        procedure=_text(about.get("label") or about.get("procedure")),
        gear=_text(gear.get("serial")) if isinstance(gear, dict) else "",
        status=status,
        duration=_number(about.get("duration")),
        rows=rows if isinstance(rows := about.get("rows"), int) else None,
        simulated=about.get("backend") == "sim",
        verdict=_text(about.get("verdict")),
        path=folder,
    )
