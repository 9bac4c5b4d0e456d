"""hdrig export RUN…: a run for other programs."""

from __future__ import annotations

import argparse
from pathlib import Path

FORMATS = ("csv", "mdf4", "mcap", "hdf5")  # as in rig.runfile.export, which is too heavy for --help


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig export`."""
    parser.add_argument(
        "runs", nargs="+", type=Path, metavar="RUN", help="run folder; a folder of runs means all in it"
    )
    parser.add_argument("--as", dest="kind", choices=FORMATS, default="csv", help="default: csv, with a row of units")
    parser.add_argument("--to", type=Path, metavar="PATH", help="file or folder; default: in the run folder")


def run(args: argparse.Namespace) -> int:
    """Prints every file made; stops at the first that cannot be."""
    from rig.commands.folders import expand
    from rig.runfile.export import export
    from rig.runfile.run import Run

    for folder in expand(args.runs):
        print(export(Run.open(folder), args.kind, args.to))
    return 0
