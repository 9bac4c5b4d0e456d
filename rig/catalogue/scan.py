"""Every run below a folder, from its manifest; a damaged one is a row that says what is wrong with it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from rig.catalogue.filter import ALL, Filter
from rig.catalogue.remembered import Remembered
from rig.catalogue.row import UNREADABLE, Row, row_of, text
from rig.core.errors import UsageError
from rig.runfile import manifest
from rig.runfile.copies import Seen, Twice, originals_first, passed_over
from rig.runfile.doubt import RESULT, doubt, quick_doubt
from rig.runfile.listing import Unread, is_run, passed_by, run_folders
from rig.runfile.process import is_being_made
from rig.runfile.remains import advice

RUNNING = "running"
ASKED = ("process", "ring", "files")  # of a manifest, each time anew: what they stand for may have changed


class Read(NamedTuple):
    """A run with what its manifest says that is asked anew each time."""

    row: Row
    about: dict[str, Any]

    @property
    def uid(self) -> str:
        """As the row has it."""
        return self.row.uid

    @property
    def path(self) -> Path:
        """As the row has it."""
        return self.row.path

    @property
    def digest(self) -> str:
        """As the row has it."""
        return self.row.digest


def runs(root: Path | str, filter: Filter = ALL, twice: Twice = passed_over) -> list[Row]:
    """The runs under `root`, in folders by date or side by side, that pass the filter, in its order; `twice` is told
    of copies. Raises UsageError without such a folder.
    """
    _refuse_no_folder(root)
    return filter.of(rows(str(root), twice))


def passing(
    roots: Sequence[Path], filter: Filter = ALL, unread: Unread = passed_by, twice: Twice = passed_over
) -> Iterator[Row]:
    """The same under any of `roots` one by one, as they lie on disk; of none is more kept than who it is; `unread` is
    told of folders that may not be looked into. Raises UsageError at once."""
    for root in roots:
        _refuse_no_folder(root)
    found = (_fresh(f"{folder}/{manifest.NAME}") for root in roots for folder in _folders(str(root), unread))
    rows = (Read(_now(row, about), about) for row, about in found)
    seen = Seen(twice)
    wanted = originals_first(one for one in rows if filter.passes(one.row))
    return (_doubted(one.row, one.about) for one in wanted if seen.is_new(one.row))


def rows(root: str, twice: Twice = passed_over) -> Iterator[Row]:
    """Every run under `root`, or the run that it is, as the disk has it, once; `twice` is told of copies."""
    seen = Seen(twice)
    return filter(seen.is_new, originals_first(map(row, _folders(root))))


def _folders(root: str, unread: Unread = passed_by) -> Iterator[str]:
    """`root` itself where it is a run folder, as for every verb that takes runs; else those below it."""
    return iter([root]) if is_run(root) else run_folders(root, unread=unread)


def row(folder: Path | str) -> Row:
    """The run in `folder`; never raises."""
    return _now(*_read(f"{folder}/{manifest.NAME}"))


def _refuse_no_folder(root: Path | str) -> None:
    if not Path(root).is_dir():
        raise UsageError(f"there is no folder {root}; give the folder that holds the runs")


def doubted(found: Row) -> Row:
    """The run with why its figures are not to be believed, all its samples looked at."""
    if found.status == UNREADABLE:
        return found
    return replace(found, doubt=text(doubt(found.path, manifest.read(found.path))))


def quickly_doubted(found: Row) -> Row:
    """The same, samples looked into only where they may have changed."""
    return found if found.status == UNREADABLE else _doubted(found, manifest.read(found.path))


def _doubted(found: Row, about: dict[str, Any]) -> Row:
    return replace(found, doubt=text(quick_doubt(found.path, about)))


def _now(found: Row, about: dict[str, Any]) -> Row:
    """A run as its manifest had it, and as its process is at this moment."""
    if found.status == RUNNING and not is_being_made(about):  # asked each time: it may have died since
        why = found.reason or f"found dead; {advice(found.path, about)}"
        return replace(found, status="interrupted", reason=why)
    return found


def _fresh(path: str) -> tuple[Row, dict[str, Any]]:
    folder = Path(path).parent
    try:
        about = manifest.read(folder)
    except UsageError as error:
        return Row(folder, status=UNREADABLE, problem=str(error)), {}
    found = row_of(folder, about)
    if not found.verdict and "files" not in about:  # somebody else's manifest is kept as it is: see `analyse_folder`
        found = replace(found, verdict=_verdict_beside(folder))
    return found, {key: about[key] for key in ASKED if key in about}


def _verdict_beside(folder: Path) -> str:
    """That of the result in a folder; "" where none is, or none can be read."""
    try:
        found = json.loads((folder / RESULT).read_bytes())
    except (OSError, ValueError, RecursionError):
        return ""
    return text(found.get("verdict")) if isinstance(found, dict) else ""


_read = Remembered(_fresh)
