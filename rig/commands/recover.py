"""hdrig recover RUN…: what a killed program left becomes a readable run."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from rig.core.errors import Exit, HdrigError


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig recover`."""
    parser.add_argument(
        "runs", nargs="+", type=Path, metavar="RUN", help="run folder; a folder of runs means all in it"
    )


def run(args: argparse.Namespace) -> int:
    """Every run is tried; one sentence each; the exit code is the first that is not 0."""
    from rig.commands.folders import expand
    from rig.runfile.recover import recover

    worst = Exit.PASS
    for folder in expand(args.runs):
        try:
            print(recover(folder).sentence)
        except HdrigError as error:
            print(f"hdrig: {error}", file=sys.stderr)
            worst = worst or Exit(error.exit)
    return int(worst)
