"""hdrig run PROCEDURE: on the twin or on a real bench, the same code."""

from __future__ import annotations

import argparse

from rig.bench import Bench
from rig.campaign.clear_of_resonance import refuse_resonance, swing_lines
from rig.campaign.plan import plan_of
from rig.campaign.sweeps import CATALOGUE as SWEEPS
from rig.campaign.sweeps import sweep_class
from rig.commands.campaign import begin
from rig.commands.limits import limit_argument, limits_of, refuse_unanswerable
from rig.commands.options import (
    bench_arguments,
    make_procedure,
    open_bench,
    parameters_of,
    plan_lines,
    procedure_arguments,
    show_argument,
)
from rig.commands.perform import Job, clear, let_be, perform
from rig.commands.show.beforehand import foretell, refusing
from rig.commands.show.show import showing
from rig.commands.viewing import view, view_argument
from rig.core.errors import UsageError
from rig.core.nearest import nearest
from rig.core.procedure import Procedure
from rig.parameters.told import told
from rig.procedures import CATALOGUE, procedure_class
from rig.refusals import refuse_beyond_limits, refuse_endless


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig run`."""
    parser.add_argument("procedure", metavar="PROCEDURE", help=", ".join([*CATALOGUE, *SWEEPS]))
    bench_arguments(parser)
    procedure_arguments(parser)
    limit_argument(parser)
    view_argument(parser)
    show_argument(parser)
    parser.add_argument(
        "--reset",
        action="store_const",
        const=clear,
        default=let_be,
        dest="before",
        help="clear a fault that is still latched before the run: only when somebody has seen that the rig is whole",
    )
    parser.add_argument(
        "--allow-resonance",
        action="store_const",
        const=into_it,
        default=refuse_resonance,
        dest="resonance",
        help="run through the speed at which order 2 meets the gear's torsional resonance",
    )
    parser.epilog = parameters_text()
    parser.add_argument("--dry-run", action="store_true", help="print what it would do and the margins; write nothing")


def parameters_text() -> str:
    """Every procedure with its parameters and their defaults, for --help."""
    lines = ["procedures and their parameters (--with NAME=VALUE, without the unit; defaults shown):"]
    kinds = {name: procedure_class(name) for name in CATALOGUE} | {name: sweep_class(name) for name in SWEEPS}
    for name, kind in kinds.items():
        summary = (kind.__doc__ or "").strip().partition("\n")[0].split("      [")[0]
        lines += [f"  {name}", f"      {summary}", *(f"      {t.line}" for t in told(kind))]
    return "\n".join(lines)


def run(args: argparse.Namespace) -> int:
    """Dry run, or proof, run, analysis, report."""
    with refusing(args.json):
        return _run(args)


def _run(args: argparse.Namespace) -> int:
    name = args.procedure.replace("_", "-")  # manifests write it with underscores
    limits = limits_of(args.limits)
    if name in SWEEPS:  # many runs, with changes by hand between them
        if limits:
            raise UsageError(
                f"--limit judges one run, and {name} makes many: hdrig analyse --limit judges each of them"
            )
        return begin(plan_of(name, parameters_of(args.parameters)), args)
    if name not in CATALOGUE:
        raise UsageError(f"no procedure called '{args.procedure}'; {nearest(name, [*CATALOGUE, *SWEEPS])}")
    kind = procedure_class(name)
    refuse_unanswerable(kind, name, limits)
    bench, clock = open_bench(args)
    procedure = make_procedure(kind, args.parameters, name)
    refuse_endless(bench, procedure)

    def check() -> None:
        refuse_beyond_limits(bench, procedure)
        args.resonance(bench, procedure)

    if args.dry_run:
        return foretell(args.json, [*plan_lines(bench, procedure), *swing_lines(bench, procedure)], check)
    note = args.note.encode("utf-8", "replace").decode()
    with showing(args.json) as show, view(args.view) as looking_on:
        check()
        return perform(Job(bench, clock, procedure, args.out, note, args.before, limits), show, looking_on)


def into_it(bench: Bench, procedure: Procedure) -> None:
    """The operator has asked for it; the limits of the bench still hold."""
