"""hdrig verify RUN…: does the folder keep its promises."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from rig.core.errors import Exit, HdrigError


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig verify`."""
    parser.add_argument(
        "runs", nargs="+", type=Path, metavar="RUN", help="run folder; a folder of runs means all in it"
    )


def run(args: argparse.Namespace) -> int:
    """One line a finding; exit 6 when a promise is broken."""
    from rig.commands.folders import expand
    from rig.runfile.verify import verify

    worst = Exit.PASS
    for folder in expand(args.runs):
        try:
            findings = verify(folder)
        except HdrigError as error:
            print(f"hdrig: {error}", file=sys.stderr)
            worst = worst or Exit(error.exit)
            continue
        broken = [f for f in findings if f.level == "error"]
        print(f"{folder.name}: {'BROKEN' if broken else 'sound'}")
        for finding in findings:
            print(f"  {finding.level:7s} {finding.sentence}")
        if broken:
            worst = worst or Exit.INCOMPLETE
    return int(worst)
