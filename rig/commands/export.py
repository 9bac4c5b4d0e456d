"""hdrig export RUN…: a run for other programs."""

from __future__ import annotations

import argparse
from pathlib import Path

from rig.commands.folders import expand, for_each, runs_argument, say_simulated
from rig.commands.targets import refuse_unwritable
from rig.core.errors import Exit, UsageError

FORMATS = ("csv", "mdf4", "mcap", "hdf5")  # as in rig.runfile.export, which is too heavy for --help


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig export`."""
    runs_argument(parser)
    parser.add_argument("--as", dest="kind", choices=FORMATS, default="csv", help="default: csv, with a row of units")
    parser.add_argument(
        "-o", "--out", "--to", type=Path, metavar="PATH", help="file or folder; default: in the run folder"
    )


def run(args: argparse.Namespace) -> int:
    """Prints every file made."""
    from rig.runfile.doubt import refuse_changed
    from rig.runfile.export import export
    from rig.runfile.run import Run

    if args.out is not None:
        refuse_unwritable(args.out if args.out.is_dir() or not args.out.suffix else args.out.parent)

    folders = expand(args.runs)
    if len(folders) > 1 and args.out is not None and args.out.suffix and not args.out.is_dir():
        raise UsageError(f"--out {args.out} is one file, and these are {len(folders)} runs: expected a folder")

    def export_one(folder: Path) -> Exit:
        recorded = Run.open(folder)
        refuse_changed(folder, recorded.manifest)
        say_simulated(folder, recorded.manifest)
        print(export(recorded, args.kind, args.out))
        return Exit.PASS

    return for_each(folders, export_one)
