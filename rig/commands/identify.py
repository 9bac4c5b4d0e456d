"""hdrig identify CAMPAIGN: all runs of one gear to the parameters of equations 6-8 and a gear file; moves nothing."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from rig.commands.folders import expand, runs_argument
from rig.commands.targets import refuse_taken
from rig.core.errors import UsageError
from rig.evaluation.identification import identify
from rig.model.fourier import PAPER_ORDERS

MOST_TERMS = 40  # a row rate of 1 kHz shows no more at the usual speeds


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig identify`."""
    runs_argument(parser)
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help="gear file to write, for example gear.toml")
    parser.add_argument(
        "--terms", type=int, default=PAPER_ORDERS, metavar="K", help=f"orders of θ̃_p, default {PAPER_ORDERS}"
    )


def run(args: argparse.Namespace) -> int:
    """Report on stdout, gear file where asked for."""
    if not 1 <= args.terms <= MOST_TERMS:
        raise UsageError(f"--terms {args.terms}: expected 1 to {MOST_TERMS} orders")
    if args.out is not None:
        refuse_taken(args.out, "-o")  # minutes of thought are not lost to a folder that is not there
    done = identify(expand(args.runs), args.terms, say)
    print("\n".join(done.lines()))
    if args.out is not None:
        from rig.model import gearfile

        gearfile.write(args.out, done.file)
        print(f"gear file {args.out}")
    return int(done.exit)


def say(text: str) -> None:
    """Progress, on stderr."""
    print(f"identify: {text}", file=sys.stderr)
