"""Run folders named on the command line."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from rig.core.errors import Exit, HdrigError, UsageError


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
            print(f"hdrig: {folder}: {error}", file=sys.stderr)
            code = Exit(error.exit)
        worst = worst or code
    return int(worst)


def expand(paths: list[Path]) -> list[Path]:
    """Run folders as given; a folder that is no run gives the runs below it. Raises UsageError when there are none."""
    found: list[Path] = []
    for path in paths:
        inside = [path] if (path / "manifest.json").exists() else sorted(p.parent for p in path.rglob("manifest.json"))
        if not inside:
            what = (
                "is neither a run folder nor holds any (no manifest.json in it)" if path.exists() else "does not exist"
            )
            raise UsageError(f"{path} {what}")
        found += inside
    return found
