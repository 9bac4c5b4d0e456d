"""One recorded run to its figures: result.json and report.html beside it, the verdict before kept as a former one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from rig.core.errors import DataError, Exit
from rig.core.kinds import Regime, regime_of
from rig.evaluation.ranges import beyond_ranges
from rig.evaluation.reference import reference_beside, reference_of_one_zero
from rig.evaluation.traceback_file import NAME as TRACEBACK
from rig.evaluation.traceback_file import keep
from rig.runfile.writing import writing

if TYPE_CHECKING:
    from rig.analysis.findings.result import Result
    from rig.runfile.run import Run

NEEDED = ("rig.analysis.analyse", "rig.report.page")
"""What `analyse_folder` imports, for those who load it once and for all beforehand."""
KEPT = (
    "Judged by the limit set in an earlier analysis ({}): --limit NAME=LIMIT sets another one of the same "
    "name, --limit NAME=none none."
)
NO_LIMITS: Mapping[str, Any] = MappingProxyType({})


def whatever(result: Result) -> None:
    """Any result is taken."""


def analyse_folder(
    folder: Path,
    target: Path,
    reference: Run | None = None,
    limits: Mapping[str, Any] = NO_LIMITS,
    accept: Callable[[Result], None] = whatever,
) -> tuple[Result, bool]:
    """Analyse one run; write result.json and report.html into `target`, which may be the run folder itself. A verdict
    that stands there already is kept in the result as a former one.

    `reference` is the slow run to split a run at speed with, or to take off a lock test's wind-up; without it the one
    in the same folder is taken. `limits` go before those the run was judged by the last time, and those before the ones
    of its manifest; one that is None lifts the limit. What `accept` raises of the result leaves all as it was. Returns
    the result, and whether the run is simulated. Raises UsageError: no run folder, or `target` cannot be written;
    DataError: samples that are not those the run was closed with.
    """
    from rig.analysis.analyse import analyse
    from rig.report.history import asked_before, with_former
    from rig.report.page import bench, write
    from rig.report.record import write_result
    from rig.runfile.doubt import refuse_changed
    from rig.runfile.events import read_events
    from rig.runfile.finalise import add_derived
    from rig.runfile.run import Run

    there = Run.open(folder)
    before = {name: limit for name, limit in asked_before(target, folder).items() if name not in limits}
    run = judged_by(there, {**before, **limits})
    refuse_changed(folder, run.manifest)
    doubt = changed_journal(folder, run.manifest)
    if reference is None:
        reference = BESIDE.get(regime_of(run.procedure), without)(run)
    result = with_former(target, analyse(run, reference, doubt, beyond_ranges(run, bench(folder))))
    accept(result)
    result = replace(result, asked=limits_in(run), cannot=(*result.cannot, *_kept(result, before, limits_in(there))))
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


def exit_of(result: Result) -> Exit:
    """PASS and MEASURED 0, FAIL 1, INCONCLUSIVE 6; 70 where a defect of hdrig left it without figures."""
    if result.defect:
        return Exit.INTERNAL
    return {"FAIL": Exit.OUT_OF_LIMITS, "INCONCLUSIVE": Exit.INCOMPLETE}.get(result.verdict, Exit.PASS)


def limits_for(folder: Path, limits: Mapping[str, Any]) -> Mapping[str, Any]:
    """Of the limits put on many runs those on figures this one is made for: a lock test is not judged by a kinematic
    error it does not measure, a run for one that lacks it is."""
    if not limits:
        return limits
    from rig.analysis.findings.figure_names import is_run_for

    procedure = procedure_in(folder)
    return {name: limit for name, limit in limits.items() if is_run_for(procedure, name)}


def procedure_in(folder: Path) -> str:
    """What its manifest calls it. Raises UsageError when there is none."""
    from rig.runfile.manifest import read

    return str(read(folder).get("procedure", ""))


def judged_by(run: Run, limits: Mapping[str, Any]) -> Run:
    """The run with `limits` before those its manifest has; the manifest on disk stays as it is."""
    if not limits:
        return run
    judged = copy(run)
    judged.manifest = {**run.manifest, "limits": {**limits_in(run), **limits}}
    return judged


def limits_in(run: Run) -> dict[str, Any]:
    """Those of its manifest."""
    return dict(run.manifest.get("limits") or {})


def _kept(result: Result, before: Mapping[str, Any], own: Mapping[str, Any]) -> list[str]:
    """Says which limits are those of the last analysis, and neither new nor the run's own."""
    kept = [words for name, words in result.limits.items() if name in before and before[name] != own.get(name)]
    return [KEPT.format(" and ".join(kept))] if kept else []


def without(run: Run) -> None:
    """What most runs are compared with."""


BESIDE: Mapping[Regime, Callable[[Run], Run | None]] = {
    Regime.AT_SPEED: reference_beside,
    Regime.LOCKED: reference_of_one_zero,
}
"""Where a run finds the slow run it is analysed with, where none is named."""


def changed_journal(folder: Path, manifest: Mapping[str, Any]) -> str:
    """Says which file of a journal that stands in for samples.parquet is not what it was; "" when each is. Raises
    DataError when one cannot be read."""
    from rig.runfile.finalise import describe
    from rig.runfile.manifest import told
    from rig.runfile.remains import journal_files

    if (folder / "samples.parquet").exists():
        return ""
    files = manifest.get("files", {})
    with told(DataError, f"the journal of {folder} cannot be read"):
        said = {p: files.get(p.name, {}).get("sha256") for p in journal_files(folder)}
        changed = [p.name for p, sha256 in said.items() if sha256 and describe(p)["sha256"] != sha256]
    return f"samples.parquet is gone, and {changed[0]} is not what it was (see hdrig verify)" if changed else ""
