"""hdrig compensate: the identified kinematic error fed forward, and how much better the load follows, measured."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rig.commands.folders import expand
from rig.commands.options import bench_arguments, open_bench
from rig.commands.show.at_the_rig import at_the_keys
from rig.commands.show.words import wired_twin
from rig.commands.targets import refuse_unwritable
from rig.core.errors import Exit, UsageError
from rig.evaluation.identification import gear_of
from rig.model.fourier import PAPER_ORDERS
from rig.runfile.manifest import utc_now
from rig.session import Session

if TYPE_CHECKING:
    from rig.model.gearfile import GearFile

SLOW = 9.6  # rpm, of the slow measurement      [ghorbel2001]
REVOLUTIONS = 8  # each way: intervals from 14 turns
FEWEST = 3  # revolutions each way: of fewer there is no interval


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig compensate`."""
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--campaign", type=Path, metavar="FOLDER", help="identify the error from the runs in there")
    source.add_argument("--gear", type=Path, metavar="GEAR", help="gear file of hdrig identify")
    parser.add_argument("--speed", type=float, nargs="+", default=[SLOW], metavar="RPM", help=f"default {SLOW}")
    parser.add_argument("--revolutions", type=int, default=REVOLUTIONS, metavar="N", help="of the motor, each way")
    bench_arguments(parser)


def run(args: argparse.Namespace) -> int:
    """Gear, then the runs, then compensation.json and compensation.html beside them."""
    from rig.closing.compensate import compensate, refuse_first, sentence
    from rig.closing.compensation_record import write_compensation
    from rig.report.closing.compensation import write

    _refuse_odd(args.speed, args.revolutions)
    bench, clock = open_bench(args)
    refuse_unwritable(args.out)
    gear = _gear(args)
    refuse_first(bench, gear, args.speed, args.revolutions)
    folder = args.out / f"{utc_now()[:10]}-{utc_now()[11:13]}{utc_now()[14:16]}{utc_now()[17:19]}-compensation"
    if bench.simulated:
        print(f"SIMULATED: bench '{bench.file.name}' is the twin, {clock} clock", file=sys.stderr)
    from rig.runfile.folder import create_in

    with (
        at_the_keys() as (interrupts, person, observer),
        Session(
            bench, clock, folder, interrupts, args.note, person, create=create_in, checks="checks", observer=observer
        ) as session,
    ):
        if session.simulated and not bench.simulated:
            say(wired_twin(bench.file.name))
        simulated = session.simulated
        mark = "SIMULATED " if simulated else ""
        found, where = compensate(
            session, gear, args.speed, args.revolutions, say, lambda one: print(f"{mark}{sentence(one)}", flush=True)
        )
    write_compensation(folder, found, where, gear, simulated)
    print(f"report {write(folder)}")
    return int(Exit.PASS if all(one.improvement > 1.0 for one in found) else Exit.OUT_OF_LIMITS)


def _refuse_odd(speeds: Sequence[float], revolutions: int) -> None:
    for rpm in speeds:
        if not (math.isfinite(rpm) and rpm > 0):
            raise UsageError(f"--speed {rpm:g}: expected rpm of the motor above 0; it goes both ways by itself")
    if revolutions < FEWEST:
        raise UsageError(f"--revolutions {revolutions}: expected {FEWEST} of the motor or more, each way")


def say(text: str) -> None:
    """Progress, on stderr."""
    print(text, file=sys.stderr)


def _gear(args: argparse.Namespace) -> GearFile:
    """Raises UsageError: no gear file, or one without a kinematic error; DataError when nothing can be identified."""
    from rig.model import gearfile

    found = gearfile.read(args.gear) if args.gear else gear_of(expand([args.campaign]), PAPER_ORDERS, say)
    if not found.kinematic_error.series.a:
        raise UsageError("the gear file holds no kinematic error; identify the gear from slow runs first")
    return found
