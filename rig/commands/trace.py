"""hdrig trace CAMPAIGN: what the paper's model lacks, found in measured runs."""

from __future__ import annotations

import argparse
import math
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from rig.commands.targets import alone_in, refuse_other_than_json, refuse_unwritable, refuse_unwritable_file
from rig.core.errors import Exit
from rig.core.loading import load
from rig.process.ctrl_c import uninterrupted
from rig.runfile.writing import writing

if TYPE_CHECKING:
    from rig.analysis.tracing.answer import NextRun
    from rig.analysis.tracing.outcome.result import Trace
    from rig.model.effect import Parameter


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig trace`."""
    parser.add_argument("campaign", type=Path, metavar="CAMPAIGN", help="folder of run folders of one rig")
    parser.add_argument(
        "--json", type=Path, metavar="FILE", help="write trace.json there too; keys in rig/analysis/tracing/REPORT.md"
    )
    parser.add_argument("-o", "--out", type=Path, metavar="FOLDER", help="write there instead of into the campaign")
    parser.add_argument(
        "--hold-out",
        action="append",
        default=[],
        metavar="GLOB",
        help="runs, by folder name, that the fit must not see; may be given again",
    )


def run(args: argparse.Namespace) -> int:
    """Trace, write, tell."""
    load("rig.analysis.tracing.trace")
    from rig.analysis.tracing.outcome.record import write_trace
    from rig.analysis.tracing.runs.campaign import folders_of_runs
    from rig.analysis.tracing.runs.holdout import refuse_unmatched
    from rig.analysis.tracing.runs.unfinished import refuse_going_on, unfinished
    from rig.analysis.tracing.trace import trace
    from rig.evaluation.trace import keep, page_of

    target = args.out or args.campaign
    if args.campaign.is_dir() and os.access(args.campaign, os.R_OK | os.X_OK):  # else that is said, not this
        refuse_unwritable(target)  # a minute of thought is not lost to a wrong name
    refuse_going_on(args.campaign)
    refuse_unmatched([run.name for run in folders_of_runs(args.campaign)], args.hold_out)
    if args.json:
        refuse_other_than_json(args.json, "--json")
    if args.json and args.json.parent != target:  # that folder is made
        refuse_unwritable_file(args.json, "--json")
    with alone_in(target):
        found = trace(args.campaign, args.hold_out, progress())
        tell(found, unfinished(args.campaign))
        page = page_of(found, args.campaign)
        from rig.report.trace.page import SWEEP  # loaded by now, and not before: see there

        with uninterrupted():
            with writing(target):
                written, report = keep(target, found, page)
            if args.json:
                with writing(args.json, "--json"):
                    write_trace(args.json, found)
    print(f"written {written}\nreport {report}")
    if (sweep := target / SWEEP).exists():
        print(f"report of the sweep {sweep}")
    return int(exit_of(found))


def progress() -> Callable[[str], None]:
    """Tells a terminal what a trace is at, and since when: it may take minutes. Nobody else is told."""
    began = time.monotonic()

    def say(text: str) -> None:
        if sys.stderr.isatty():
            print(f"{time.monotonic() - began:4.0f} s  {text}", file=sys.stderr, flush=True)

    return say


def exit_of(found: Trace) -> Exit:
    """0 when explained or nothing is missing, 6 when ambiguous or unknown."""
    return Exit.PASS if found.verdict.status in ("explained", "no_missing_effect") else Exit.INCOMPLETE


def asked(run: NextRun) -> str:
    """Procedure, conditions with their units, and why."""
    from rig.report.rows import measured

    rows = [measured(key, value) for key, value in run.conditions.items()]
    at = ", ".join(f"{row.name} {row.value}" for row in rows)
    return f"{run.procedure.replace('_', '-')}{f' at {at}' if at else ''}: {run.because}"


def _is_any_phase(p: Parameter) -> bool:
    """Of a wave that is not told from none: its amplitude says so, and the phase says nothing."""
    return p.name.endswith("_phase") and p.ci95[1] - p.ci95[0] > math.pi


def tell(found: Trace, first: str = "") -> None:
    """Verdict, parameters, errors before and after, on stdout; what is to be known `first` stands below the head."""
    from rig.analysis.tracing.outcome.without import counted_out
    from rig.report.trace.channels import held_out_with
    from rig.report.trace.sizes import said
    from rig.report.trace.words import added, beside_laws, gloss, not_read, remainder, runs_read

    out = f", {counted_out(found)} left out" if found.left_out else ""
    print(f"{'SIMULATED ' if found.simulated else ''}{found.campaign}: {found.verdict.status.replace('_', ' ')}{out}")
    if first:
        print(f"  {first}")
    if found.left_out:
        print(f"  {runs_read(found)} read. {not_read(found)}")
    print(f"  {found.verdict.sentence}")
    for law in found.law:
        print(f"  {law}")
    if found.verdict.status == "unknown_effect" and found.added_curves:
        print(f"  {beside_laws(found) if found.law else added(found)}")
    if rest := remainder(found):
        print(f"  {rest}")
    for effect in found.effects:
        for p in (p for p in effect.parameters if not _is_any_phase(p)):
            what = gloss(effect.effect, p.name, p.unit)
            print(f"  {effect.effect} {p.name} {said(p)}" + (f"  {what}" if what else ""))
    for label, name in (("kinematic error", "theta_l"), ("motor torque", "tau_m"), ("shaft torque", "tau_l")):
        if name in found.ratios_before:
            print(
                f"  {label} on {held_out_with(found, name)}: "
                f"{found.ratios_before[name]:.2f} → {found.ratios_after[name]:.2f} times the floor"
            )
    if found.next_run:
        print(f"  next run: {asked(found.next_run)}")
    for note in (*(note for note in found.notes if note != first), *found.cannot):
        print(f"  note: {note}")
