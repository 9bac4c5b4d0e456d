"""Options that several verbs share, and procedure parameters as options of their own."""

from __future__ import annotations

import argparse
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from rig.bench import Bench, ClockName, read, toml_value
from rig.config import nearest
from rig.core.errors import UsageError
from rig.core.procedure import Procedure


def bench_arguments(parser: argparse.ArgumentParser) -> None:
    """--bench, --set, --seed, --clock, --out, --note."""
    parser.add_argument("--bench", default="twin", metavar="FILE", help="bench file, or the name of one that ships")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="change a number of the bench file for this run"
    )
    parser.add_argument("--seed", type=int, metavar="N", help="seed of the twin, short for --set twin.seed=N")
    parser.add_argument(
        "--clock", choices=["virtual", "wall"], help="virtual: as fast as it goes (twin only); wall: real time"
    )
    parser.add_argument("--out", type=Path, default=Path("runs"), metavar="FOLDER", help="where run folders go")
    parser.add_argument("--note", default="", metavar="TEXT", help="kept in the run's manifest")


def open_bench(args: argparse.Namespace) -> tuple[Bench, ClockName]:
    """The bench the options describe, and its clock: virtual on the twin unless told otherwise."""
    seed = [] if args.seed is None else [f"twin.seed={args.seed}"]
    bench = read(args.bench, [*args.set, *seed])
    return bench, args.clock or ("virtual" if bench.simulated else "wall")


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


def make_procedure(kind: type[Procedure], assignments: list[str]) -> Procedure:
    """The procedure with its parameters set. Raises UsageError: unknown name, wrong type, value that makes no sense."""
    known = {f.name: f for f in fields(kind)}  # type: ignore[arg-type]
    values: dict[str, Any] = {}
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        if not equals:
            raise UsageError(f"--with {assignment}: expected name=value, for example cycles=1")
        if name not in known:
            raise UsageError(f"{kind.name} has no parameter '{name}'; {nearest(name, known)}")
        value, default = toml_value(text), known[name].default
        wanted = type(default) if default is not MISSING else str
        if wanted is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if not isinstance(value, wanted) or value != value or value in (float("inf"), float("-inf")):
            raise UsageError(f"{name} = {text}: expected {a_word(wanted)}, for example {default}")
        signed = known[name].metadata.get("signed", False)
        if isinstance(value, float | int) and not isinstance(value, bool) and value <= 0 and not signed:
            raise UsageError(f"{name} = {text}: expected more than 0, for example {default}")
        values[name] = value
    try:
        return kind(**values)
    except (OverflowError, ZeroDivisionError):
        raise UsageError(f"{kind.name}: the parameters {', '.join(assignments)} cannot be meant") from None


def a_word(kind: type) -> str:
    """How a person calls a type."""
    return {float: "a finite number", int: "a whole number", str: "text", bool: "true or false"}.get(
        kind, kind.__name__
    )


def plan_lines(bench: Bench, procedure: Procedure) -> list[str]:
    """What a dry run prints: travel, speed, torque, energy, duration, bytes, and the margins to every limit."""
    from rig.core.channels import CHANNELS
    from rig.session import margins

    envelope = procedure.envelope(bench.setting(lambda text: None))
    rows = int(envelope.duration * bench.file.loop.rate)
    size = rows * 8 * len(CHANNELS) * 1.4 / 1e6  # journal as it is, archive at about 0.4 of it
    gear = bench.file.gear
    inertia = gear.J_m + gear.J_l / gear.N**2
    lines = [
        f"procedure   {procedure.title()} on {bench.file.name}{' (SIMULATED)' if bench.simulated else ''}",
        f"duration    {envelope.duration:.1f} s of rig time, {rows} rows, about {size:.0f} MB",
        f"energy      {0.5 * inertia * envelope.speed**2:.4f} J in motion, at the motor's speed",
    ]
    for what, asked, limit, unit, scale in margins(bench, procedure):
        if what == "torque":  # the loop is clamped there: what it will need is known only once it runs
            lines.append(f"{what:11s} at most {asked * scale:g} {unit} (clamped), limit {limit * scale:g} {unit}")
            continue
        lines.append(
            f"{what:11s} {asked * scale:g} of {limit * scale:g} {unit}, margin {100 * (1 - asked / limit):.0f} %"
        )
    return lines
