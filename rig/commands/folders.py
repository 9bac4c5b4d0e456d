"""Run folders named on the command line."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from rig.core.errors import Exit, HdrigError, UsageError, said_of
from rig.runfile.listing import runs_in
from rig.runfile.origin import SIM


def runs_argument(parser: argparse.ArgumentParser) -> None:
    """RUN…"""
    parser.add_argument(
        "runs", nargs="+", type=Path, metavar="RUN", help="run folder; a folder of runs means all in it"
    )


def for_each(folders: list[Path], act: Callable[[Path], Exit]) -> int:
    """Every run is tried; a refusal is a sentence on stderr; the exit code is that of the first that is not 0."""
    worst = Exit.PASS
    for folder in folders:
        try:
            code = act(folder)
        except HdrigError as error:
            print(f"hdrig: {folder}: {said_of(folder, error)}", file=sys.stderr)
            code = Exit(error.exit)
        worst = worst or code
    return int(worst)


def say_simulated(folder: Path, manifest: Mapping[str, Any]) -> None:
    """On stderr, where the samples are the twin's: stdout is the path of what is made of them, and no more."""
    if manifest.get("backend") == SIM:
        print(f"SIMULATED: {folder} was recorded on the twin", file=sys.stderr)


def say_unread(error: OSError) -> None:
    """On stderr: what runs may lie there is not known."""
    print(f"left out: {error.filename} cannot be read: {error.strerror}", file=sys.stderr)


def say_twice(folder: Path, why: str) -> None:
    """On stderr: a copy is no run of its own."""
    print(f"left out: {folder}: {why}", file=sys.stderr)


def expand(paths: list[Path]) -> list[Path]:
    """Run folders as given; a folder that is no run gives the runs below it.

    Files among several paths, as a shell gives them for `CAMPAIGN/*`, are left out in a sentence on stderr. Raises
    UsageError for a path that does not exist, a folder without runs, and when no run is left.
    """
    found: list[Path] = []
    files: list[Path] = []
    for path in paths:
        inside = runs_in(path, say_unread)
        if not inside and path.is_file() and len(paths) > 1:
            files.append(path)
        elif not inside:
            what = (
                "is neither a run folder nor holds any (no manifest.json in it)" if path.exists() else "does not exist"
            )
            raise UsageError(f"{path} {what}")
        found += inside
    named = ", ".join(path.name for path in files)
    if files and not found:
        raise UsageError(f"{named}: expected run folders, these are files")
    if files:
        print(f"left out, for they are files and no runs: {named}", file=sys.stderr)
    return found
