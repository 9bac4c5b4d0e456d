"""Where a verb is to write: tried before anything moves, and what is said when it cannot be written."""

from __future__ import annotations

import contextlib
import errno
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from rig.core.errors import UsageError
from rig.runfile.process import sole_writer
from rig.runfile.text_path import refuse_no_text
from rig.runfile.writing import writing

BLOCK = bytes(4096)  # a folder can still be made on a disk that has no block left
BELOW = "r" * 120  # as long as a run folder and a file in it: the longest path has to leave room for them


def refuse_unwritable(folder: Path, option: str = "--out") -> None:
    """Raises UsageError when `folder`, or the nearest one above it that exists, takes no new file, or
    when no folder of that name can be made there. Leaves nothing.
    """
    refuse_no_text(folder, option)
    with writing(folder, option):
        there = folder
        while not os.path.lexists(there) and there != there.parent:
            there = there.parent
        missing = [name for name in folder.relative_to(there).parts if name != ".."]
        with tempfile.TemporaryDirectory(dir=there, prefix=".hdrig-") as tried:
            made = Path(tried, *missing)
            made.mkdir(parents=True, exist_ok=True)
            (made / BELOW).write_bytes(BLOCK)


def refuse_unwritable_file(path: Path, option: str) -> None:
    """Raises UsageError when no file can be written at `path`: its folder has to be there. Leaves nothing."""
    with writing(path, option):
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder")
        if not path.parent.is_dir():
            if os.path.lexists(path.parent):
                raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
            raise FileNotFoundError(errno.ENOENT, f"there is no folder {path.parent}")
        if path.exists() and not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    refuse_unwritable(path.parent, option)


def refuse_taken(path: Path, option: str) -> None:
    """Raises UsageError when something is at `path` already, or when no file can be written there: what a user names
    may be the only copy of something. Leaves nothing."""
    if os.path.lexists(path):
        raise UsageError(f"{option} {path} exists already; nothing is overwritten: give the name of a new file")
    refuse_unwritable_file(path, option)


def refuse_other_than_json(path: Path, option: str) -> None:
    """Raises UsageError when what is at `path` is a file of something else than an object in JSON, which a program
    writes anew each time."""
    with writing(path, option):
        other = path.is_file() and _first(path) not in (b"", b"{")
    if other:
        raise UsageError(f"{option} {path} exists already and is no JSON; nothing else is overwritten")


def _first(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(1)


@contextlib.contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Make `folder` and hold it for this process alone; it goes again where nothing came of it. Raises NotReady when
    another process writes there, UsageError when it cannot be made."""
    made = not folder.exists()
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    try:
        with sole_writer(folder):
            yield
    finally:
        if made:
            with contextlib.suppress(OSError):
                folder.rmdir()
