"""hdrig analyse RUN…: figures and report from what is recorded; never touches a device."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rig.commands.folders import expand, for_each, runs_argument
from rig.commands.limits import limit_argument, limits_of, refuse_absent, refuse_not_given
from rig.core.errors import Exit
from rig.core.loading import load
from rig.evaluation.reference import reference_named
from rig.evaluation.run import NEEDED, analyse_folder, exit_of, limits_for, procedure_in, whatever

if TYPE_CHECKING:
    from rig.analysis.findings.result import Result

CHECKS, CAMPAIGN = "checks", "campaign.json"  # folder and file of a campaign


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig analyse`."""
    runs_argument(parser)
    parser.add_argument(
        "-o", "--out", type=Path, metavar="FOLDER", help="write results there instead of into the run folders"
    )
    parser.add_argument(
        "--reference",
        type=Path,
        metavar="RUN",
        help="slow run (kinematic-error) to split runs at speed with and to take off the wind-up of lock tests; "
        "without it the one beside them is taken",
    )
    limit_argument(parser)


def run(args: argparse.Namespace) -> int:
    """Figures and report of every run."""
    load(*NEEDED)
    folders = without_checks(expand(args.runs), args.runs)
    places = dict(zip(folders, targets(folders, args.out), strict=True))
    reference = reference_named(args.reference) if args.reference else None
    limits = limits_of(args.limits)

    def analyse_one(folder: Path) -> Exit:
        """One of them, by the limits that are made for it."""
        if len(folders) == 1:  # nothing else it could be meant for
            return judged(folder, limits, only_by(folder, limits))
        mine = limits_for(folder, limits)
        code = judged(folder, mine, whatever)
        for name in [n for n in limits if n not in mine]:
            print(f"  not judged by {name}, for which such a run is not made")
        return code

    def judged(folder: Path, by: Mapping[str, Any], accept: Callable[[Result], None]) -> Exit:
        result, simulated = analyse_folder(folder, places[folder], reference, by, accept)
        print_result(result, places[folder], folder, simulated)
        return exit_of(result)

    return for_each(folders, analyse_one)


def only_by(folder: Path, limits: Mapping[str, Any]) -> Callable[[Result], None]:
    """What refuses a result without the figures the run is to be judged by. Raises UsageError at once when such a run
    is not made for one."""
    procedure = procedure_in(folder)
    asked = {name: limit for name, limit in limits.items() if limit is not None}
    refuse_not_given(procedure, procedure.replace("_", "-"), asked)
    return lambda result: refuse_absent([e.name for e in result.estimates], asked)


def without_checks(folders: list[Path], named: list[Path]) -> list[Path]:
    """Runs without the checks a campaign makes between them, which measure no figure; `named` ones, and checks alone,
    stay. Says on stderr how many were left out."""
    left = [f for f in folders if f in named or not (f.parent.name == CHECKS and (f.parents[1] / CAMPAIGN).exists())]
    count = len(folders) - len(left)
    if not left or not count:
        return folders
    print(
        f"left out: {count} check{'' if count == 1 else 's'} between the runs; name one to analyse it", file=sys.stderr
    )
    return left


def targets(folders: list[Path], out: Path | None) -> list[Path]:
    """Where the results of each run go: beside it, or below `out` as the runs lie below what they have in common."""
    if out is None:
        return folders
    base = os.path.commonpath([folder.resolve().parent for folder in folders])
    return [out / folder.resolve().relative_to(base) for folder in folders]


def print_result(result: Result, target: Path, folder: Path, simulated: bool) -> None:
    """Verdict, figures with unit and interval, and where the report is, on stdout; a defect of ours on stderr too."""
    from rig.report.text.result import lines

    print("\n".join(lines(result, folder.resolve().name, simulated)))
    if result.defect:
        print(f"hdrig: {folder}: {result.sentence}", file=sys.stderr)
    print(f"report {target / 'report.html'}")
