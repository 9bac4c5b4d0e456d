"""hdrig demo: the main job end to end on the twin, in virtual time."""

from __future__ import annotations

import argparse
from pathlib import Path

from rig.bench import read
from rig.commands.options import seed_argument
from rig.commands.perform import Job, perform
from rig.commands.show.show import showing
from rig.procedures.kinematic_error import KinematicError
from rig.session.observer import Observer


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig demo`."""
    seed_argument(parser, default=1, help="seed of the twin")
    parser.add_argument("-o", "--out", type=Path, default=Path("runs"), metavar="FOLDER", help="where run folders go")


def run(args: argparse.Namespace) -> int:
    """The paper's slow measurement with its defaults: ±1440° at 0.01 Hz, two cycles, 1 kHz."""
    bench = read("twin", [f"twin.seed={args.seed}"])
    with showing(json=False) as show:
        return perform(Job(bench, "virtual", KinematicError(), args.out, "demo"), show, Observer())
