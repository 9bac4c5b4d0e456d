"""Run folders below a folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from rig.runfile.manifest import NAME, is_nameless
from rig.runfile.remains import hold_samples

Unread = Callable[[OSError], object]
"""Told of a folder that may not be looked into."""


def passed_by(error: OSError) -> None:
    """For whom a folder that is not theirs to look into is none of their runs."""


def is_run(path: Path | str) -> bool:
    """True for a folder with a manifest, or with samples that have lost it: every verb has a word for such a one.
    Raises PermissionError where that cannot be seen."""
    try:
        os.stat(f"{path}/{NAME}")
    except FileNotFoundError:
        return is_nameless(Path(path))
    except PermissionError:
        raise
    except (OSError, ValueError):
        return False
    return True


def runs_in(path: Path, unread: Unread = passed_by) -> list[Path]:
    """`path` where it is a run folder, else every one below it, however deep, in the order of their names; hidden
    ones are passed by. Raises PermissionError where that cannot be seen."""
    if is_run(path):
        return [path]
    found = []
    for at, folders, files in os.walk(path, onerror=unread) if path.is_dir() else ():
        if NAME in files or NAME in folders or hold_samples(files):
            found.append(Path(at))
        folders[:] = [name for name in folders if not name.startswith(".")]  # what is below those is not looked at
    return sorted(found)


def run_folders(root: str, depth: int = 3, unread: Unread = passed_by) -> Iterator[str]:
    """Run folders, as `is_run` has it, down to ./runs/date/run, by name, links last; hidden ones are passed by."""
    try:
        entries = os.scandir(root)
    except OSError as error:
        unread(error)
        return
    with entries:
        for entry in _links_last(entries):
            if entry.name.startswith(".") or not _is_folder(entry):
                continue
            try:
                found = is_run(entry.path)
            except PermissionError as error:
                unread(error)
                continue
            if found:
                yield entry.path
            elif depth > 1:
                yield from run_folders(entry.path, depth - 1, unread)


def _links_last(entries: Iterable[os.DirEntry[str]]) -> list[os.DirEntry[str]]:
    return sorted(entries, key=lambda entry: (entry.is_symlink(), entry.name))


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # a link in a ring, or to where nobody may look
        return False
