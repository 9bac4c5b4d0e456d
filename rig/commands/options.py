"""Options that several verbs share, and procedure parameters as options of their own."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from rig.bench import Bench, ClockName, read, shipped, toml_value
from rig.campaign.preview import plan_lines as plan_lines  # for the verbs that dry-run
from rig.core.errors import UsageError
from rig.core.procedure import Procedure
from rig.parameters.read import make


def bench_arguments(parser: argparse.ArgumentParser) -> None:
    """--bench, --set, --seed, --clock, --out, --note."""
    bench_argument(parser)
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="change a number of the bench file for this run"
    )
    seed_argument(parser, help="seed of the twin, short for --set twin.seed=N")
    parser.add_argument(
        "--clock",
        choices=["virtual", "wall"],
        help="virtual: as fast as it goes, the default on the twin, and for it alone; wall: real time",
    )
    parser.add_argument(
        "-o", "--out", type=Path, default=Path("runs"), metavar="FOLDER", help="where run folders go; default: runs"
    )
    parser.add_argument("--note", default="", metavar="TEXT", help="kept in the run's manifest")


def bench_argument(parser: argparse.ArgumentParser, default: str | None = "twin") -> None:
    """--bench; without a `default` it has to be given."""
    names = f"bench file, or the name of one that ships ({', '.join(shipped())}: all SIMULATED)"
    told = names if default is None else f"{names}; default: {default}"
    parser.add_argument("--bench", default=default, required=default is None, metavar="FILE", help=told)


def seed_argument(parser: argparse.ArgumentParser, **how: Any) -> None:
    """--seed."""
    parser.add_argument("--seed", type=_seed, metavar="N", **how)


def _seed(text: str) -> int:
    """Whole, from 0 on."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r}: expected a whole number, 0 or more")
    return int(text)


def show_argument(parser: argparse.ArgumentParser) -> None:
    """--json."""
    parser.add_argument(
        "--json", action="store_true", help="every event as a JSON line on stdout; keys in rig/commands/show/show.py"
    )
    parser.set_defaults(events=True)  # what --json means here: a refusal of the command line itself is one too


def open_bench(args: argparse.Namespace) -> tuple[Bench, ClockName]:
    """The bench the options describe, and its clock: virtual on the twin unless told otherwise. Raises UsageError."""
    seed = [] if args.seed is None else [f"twin.seed={args.seed}"]
    bench = read(args.bench, [*args.set, *seed])
    clock: ClockName = args.clock or ("virtual" if bench.simulated else "wall")
    bench.refuse_clock(clock)
    return bench, clock


def procedure_arguments(parser: argparse.ArgumentParser) -> None:
    """--with NAME=VALUE."""
    parser.add_argument(
        "--with",
        action="append",
        default=[],
        dest="parameters",
        metavar="NAME=VALUE",
        help="a parameter of the procedure, for example --with cycles=1",
    )


def make_procedure(kind: type[Procedure], assignments: list[str], called: str) -> Procedure:
    """The procedure, `called` so, with its parameters set. Raises UsageError: unknown name, wrong type, a value that
    makes no sense."""
    return make(kind, parameters_of(assignments), called)


def parameters_of(assignments: list[str]) -> dict[str, Any]:
    """What --with says, each value as TOML writes it. Raises UsageError."""
    values: dict[str, Any] = {}
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        if not equals:
            raise UsageError(f"--with {assignment}: expected name=value, for example cycles=1")
        if name in values:
            raise UsageError(f"--with {assignment}: {name} is given already, as {values[name]}; expected each one once")
        values[name] = toml_value(text)
    return values
