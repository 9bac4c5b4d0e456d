"""Run folders below a folder."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from rig.runfile.manifest import NAME


def runs_in(path: Path) -> list[Path]:
    """`path` where it is a run folder, else every one below it, however deep, in the order of their names."""
    return [path] if (path / NAME).exists() else sorted(found.parent for found in path.rglob(NAME))


def run_folders(root: str, depth: int = 3) -> Iterator[str]:
    """Folders with a manifest, down to ./runs/date/run; hidden ones are passed by."""
    try:
        entries = os.scandir(root)
    except OSError:  # not ours to look into
        return
    with entries:
        for entry in entries:
            if entry.name.startswith(".") or not _is_folder(entry):
                continue
            if os.path.exists(f"{entry.path}/{NAME}"):
                yield entry.path
            elif depth > 1:
                yield from run_folders(entry.path, depth - 1)


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # a link in a ring, or to where nobody may look
        return False
