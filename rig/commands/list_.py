"""hdrig list: the runs in a folder, from their manifests alone."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from rig.core.errors import UsageError


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig list`."""
    parser.add_argument("root", nargs="?", type=Path, default=Path("runs"), metavar="FOLDER", help="default: runs")


def run(args: argparse.Namespace) -> int:
    """One line a run, oldest first."""
    from rig.runfile.listing import list_runs

    if not args.root.is_dir():
        raise UsageError(f"{args.root} is no folder; give the folder that holds the runs")
    rows = list_runs(args.root)
    if not rows:
        print(f"no runs in {args.root}")
        return 0
    _say(f"{'started (UTC)':19s} {'procedure':18s} {'gear':16s} {'status':12s} {'duration':>9s} {'verdict':12s} run")
    for row in rows:
        duration = "–" if row.duration is None else f"{row.duration:.1f} s"
        mark = " SIMULATED" if row.simulated else ""
        _say(
            f"{row.started_utc[:19]:19s} {row.procedure:18s} {row.gear:16s} {row.status:12s} {duration:>9s} "
            f"{row.verdict or '–':12s} {row.path}{mark}"
        )
    return 0


def _say(line: str) -> None:
    """Print what a terminal can take: names of folders and words of manifests may be anything."""
    shown = "".join(c if c.isprintable() else "\ufffd" for c in line)
    encoding = sys.stdout.encoding or "utf-8"
    print(shown.encode(encoding, "replace").decode(encoding))
