"""hdrig analyse RUN…: figures and report from what is recorded; never touches a device."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from rig.commands.folders import expand, for_each, runs_argument
from rig.commands.limits import limit_argument, limits_of
from rig.commands.loading import load
from rig.commands.reference import reference_beside, reference_named, reference_of_one_zero
from rig.commands.targets import writing
from rig.commands.traceback_file import NAME as TRACEBACK
from rig.commands.traceback_file import keep
from rig.core.errors import DataError, Exit

if TYPE_CHECKING:
    from rig.analysis.findings.result import Result
    from rig.runfile.run import Run

PAGE = "rig.report.page"
CHECKS, CAMPAIGN = "checks", "campaign.json"  # folder and file of a campaign
NO_LIMITS: Mapping[str, Any] = MappingProxyType({})


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig analyse`."""
    runs_argument(parser)
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="write results there instead of into the run folders"
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
    load("rig.analysis.analyse", PAGE)
    folders = without_checks(expand(args.runs), args.runs)
    places = dict(zip(folders, targets(folders, args.out), strict=True))
    reference = reference_named(args.reference) if args.reference else None
    limits = limits_of(args.limits)

    def analyse_one(folder: Path) -> Exit:
        mine = limits if len(folders) == 1 else limits_for(folder, limits)
        result, simulated = analyse_folder(folder, places[folder], reference, mine)
        print_result(result, places[folder], folder, simulated)
        for name in [n for n in limits if n not in mine]:
            print(f"  not judged by {name}, for which such a run is not made")
        return exit_of(result)

    return for_each(folders, analyse_one)


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


def limits_for(folder: Path, limits: Mapping[str, Any]) -> Mapping[str, Any]:
    """Of the limits put on many runs those on figures this one is made for: a lock test is not judged by a kinematic
    error it does not measure, a run for one that lacks it is."""
    if not limits:
        return limits
    from rig.analysis.findings.figure_names import is_run_for
    from rig.runfile.manifest import read

    procedure = str(read(folder).get("procedure", ""))
    return {name: limit for name, limit in limits.items() if is_run_for(procedure, name)}


def targets(folders: list[Path], out: Path | None) -> list[Path]:
    """Where the results of each run go: beside it, or below `out` as the runs lie below what they have in common."""
    if out is None:
        return folders
    base = os.path.commonpath([folder.resolve().parent for folder in folders])
    return [out / folder.resolve().relative_to(base) for folder in folders]


def analyse_folder(
    folder: Path, target: Path, reference: Run | None = None, limits: Mapping[str, Any] = NO_LIMITS
) -> tuple[Result, bool]:
    """Analyse one run; write result.json and report.html into `target`, which may be the run folder itself. A verdict
    that stands there already is kept in the result as a former one.

    `reference` is the slow run to split a run at speed with, or to take off a lock test's wind-up; without it the one
    in the same folder is taken. `limits` join those of the run's manifest and go before them. Returns the result, and
    whether the run is simulated.
    """
    from rig.analysis.analyse import analyse
    from rig.report.history import with_former
    from rig.report.page import write
    from rig.report.record import write_result
    from rig.runfile.events import read_events
    from rig.runfile.finalise import add_derived
    from rig.runfile.run import Run

    run = judged_by(Run.open(folder), limits)
    refuse_changed(folder, run.manifest)
    if reference is None:
        reference = BESIDE.get(run.procedure, without)(run)
    result = with_former(target, analyse(run, reference))
    if result.broke_off:
        result = replace(result, sentence=f"{result.sentence} Where it did stands in {TRACEBACK}.")
    with writing(target):
        target.mkdir(parents=True, exist_ok=True)
        keep(target, result.broke_off)
        made = [
            write_result(target, result),
            write(target, run.manifest, dict(run.timing), read_events(folder), result, run=folder),
        ]
    if target == folder and "files" in run.manifest:  # a folder somebody else made keeps its manifest as it is
        add_derived(folder, *(path.name for path in made), verdict=str(result.verdict))
    return result, run.simulated


def judged_by(run: Run, limits: Mapping[str, Any]) -> Run:
    """The run with `limits` before those its manifest has; the manifest on disk stays as it is."""
    if not limits:
        return run
    own = run.manifest.get("limits")
    both = {**(own if isinstance(own, Mapping) else {}), **limits}
    return type(run)(run.path, {**run.manifest, "limits": both}, run.samples)


def without(run: Run) -> None:
    """What most procedures are compared with."""


BESIDE: Mapping[str, Callable[[Run], Run | None]] = {
    "constant_torque": reference_beside,
    "constant_speed": reference_beside,
    "sentinel": reference_beside,
    "stiffness_lock": reference_of_one_zero,
}
"""Where a procedure finds the slow run it is analysed with, where none is named."""


def refuse_changed(folder: Path, manifest: Mapping[str, Any]) -> None:
    """Figures from samples that are not those that were closed would be worth nothing. Raises DataError."""
    from rig.runfile.finalise import describe
    from rig.runfile.manifest import told

    said, path = manifest.get("files", {}).get("samples.parquet", {}).get("sha256"), folder / "samples.parquet"
    if not said or not path.exists():
        return
    with told(DataError, f"{path} cannot be read"):
        same = describe(path)["sha256"] == said
    if not same:
        raise DataError(
            "samples.parquet is not the file this run was closed with (its SHA-256 differs): see hdrig verify"
        )


def exit_of(result: Result) -> Exit:
    """PASS and MEASURED 0, FAIL 1, INCONCLUSIVE 6; 70 where a defect of hdrig left it without figures."""
    if result.defect:
        return Exit.INTERNAL
    return {"FAIL": Exit.OUT_OF_LIMITS, "INCONCLUSIVE": Exit.INCOMPLETE}.get(result.verdict, Exit.PASS)


def print_result(result: Result, target: Path, folder: Path, simulated: bool) -> None:
    """Verdict, figures with unit and interval, and where the report is, on stdout."""
    from rig.analysis.sensors.latch_skew_words import bench_lines
    from rig.report.history import told
    from rig.report.numbers import estimate

    said = {"MEASURED": "no limit set"}.get(result.verdict, str(result.verdict))
    print(f"{'SIMULATED ' if simulated else ''}{folder.name}\n{said}: {result.sentence}")
    if history := told(result, last=1):
        print(history)
    width = max((len(e.label) for e in result.estimates), default=0)
    for e in result.estimates:
        print(f"  {e.label:{width}s}  {estimate(e.value, e.ci95, e.unit)}")
    for check in result.checks:
        if not check.passed:
            print(f"  not met: {check.sentence}")
    for sentence in result.cannot:
        print(f"  cannot tell: {sentence}")
    for line in bench_lines(result):
        print(line)
    if result.defect:  # the console shows the last line of what stands on stderr
        print(f"hdrig: {folder}: {result.sentence}", file=sys.stderr)
    print(f"report {target / 'report.html'}")
