"""hdrig tune: gains that turn the motor smoothly at the slow speed, found on the rig at hand."""

from __future__ import annotations

import argparse
import shlex
import sys
from pathlib import Path

from rig.commands.options import bench_arguments, open_bench
from rig.commands.show.at_the_rig import at_the_keys
from rig.commands.show.words import wired_twin
from rig.commands.targets import refuse_taken, refuse_unwritable
from rig.core.errors import Exit
from rig.runfile.manifest import write_atomic
from rig.runfile.writing import writing
from rig.session import Session
from rig.tuning import BANDWIDTHS, as_it_was, describe, find_gains, no_better


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig tune`."""
    bench_arguments(parser)
    parser.add_argument("--write", type=Path, metavar="FILE", help="new bench file with the gains found")


def run(args: argparse.Namespace) -> int:
    """Steps, trials, after and before; exit 1 when no gains pass."""
    bench, clock = open_bench(args)
    refuse_unwritable(args.out)
    if args.write is not None:
        refuse_taken(args.write, "--write")
    if bench.simulated:
        print(f"SIMULATED: bench '{bench.file.name}' is the twin, {clock} clock", file=sys.stderr)
    with (
        at_the_keys() as (interrupts, _, observer),
        Session(bench, clock, args.out, interrupts, args.note or "tuning", observer=observer) as session,
    ):
        if session.simulated and not bench.simulated:
            say(wired_twin(bench.file.name))
        best = find_gains(session, bench, print, say)
        if best is not None and args.write is not None:
            with writing(args.write, "--write"):
                write_atomic(args.write, best[0].text.encode())
            changed = f", with the changes of --set ({', '.join(args.set)})" if args.set else ""
            print(
                f"bench file with the gains found written to {args.write}{changed}: use it with "
                f"--bench {shlex.quote(str(args.write))}"
            )
        before = as_it_was(session, bench)
        print(f"before: {describe(bench, before)}")
    if best is None:
        print(f"FAIL: no bandwidth up to {BANDWIDTHS[-1]:g} rad/s turned the motor smoothly")
        return int(Exit.OUT_OF_LIMITS)
    print(f"after:  {describe(*best)}")
    if no_better(before, best[1]):
        print("no better: one trial each, and the bench's own gains turn the motor as evenly; they may stay")
    return int(Exit.PASS)


def say(text: str) -> None:
    """Progress, on stderr."""
    print(text, file=sys.stderr)
