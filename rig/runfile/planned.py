"""Runs that the book of a campaign calls done, and where they lie by now: a folder may be renamed, or gone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from rig.core.errors import UsageError
from rig.runfile import manifest


class Done(NamedTuple):
    """A run that was made."""

    number: int  # in its campaign, from 1
    name: str  # of its folder, as the book has it
    folder: Path | None  # where it lies; None where it does not


def done_runs(folder: Path, book: Mapping[str, Any]) -> list[Done]:
    """Those of the campaign in `folder`, by number; one that was renamed is known by campaign, number and uid."""
    runs = [entry if isinstance(entry, dict) else {} for entry in book.get("runs", [])]
    names = {
        k: str(entry["run"]) for k, entry in enumerate(runs, 1) if entry.get("status") == "done" and entry.get("run")
    }
    if all((folder / name).is_dir() for name in names.values()):
        return [Done(k, name, folder / name) for k, name in names.items()]
    others = _manifests(path.parent for path in sorted(folder.glob("[!.]*/manifest.json")))
    return [
        Done(k, name, _there(folder / name) or _renamed(others, book.get("uid"), k, name)) for k, name in names.items()
    ]


def _there(folder: Path) -> Path | None:
    return folder if folder.is_dir() else None


def _manifests(folders: Iterable[Path]) -> dict[Path, manifest.Manifest]:
    found = {}
    for folder in folders:
        try:
            found[folder] = manifest.read(folder)
        except UsageError:  # it says nothing of whose it is
            continue
    return found


def _renamed(others: Mapping[Path, manifest.Manifest], campaign: object, number: int, name: str) -> Path | None:
    """The folder of run `number` that was called `name`, which ends with the first four digits of its uid."""
    for folder, about in others.items():
        of, uid = about.get("campaign"), str(about.get("uid", ""))
        mine = isinstance(of, dict) and (of.get("uid"), of.get("run")) == (campaign, number)
        if mine and uid and name.endswith(f"-{uid[:4]}"):
            return folder
    return None
