"""The runs an identification goes by: opened, of one gear in one assembly, none of them odd beside the others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from rig.core.errors import DataError, HdrigError, said_of
from rig.runfile.copies import once
from rig.runfile.doubt import changed
from rig.runfile.misfits import notes

if TYPE_CHECKING:
    from rig.analysis.identify.recording import Recording
    from rig.runfile.run import Run

Say = Callable[[str], None]
"""Told of progress; what it is told need not be kept."""
FEW: Final = 2  # names in one sentence


class Opened(NamedTuple):
    """All runs of the campaign, those that identification can read, and what is to be known of the others."""

    runs: list[Run]
    recordings: list[Recording]
    said: tuple[str, ...] = ()


def open_runs(folders: Sequence[Path], say: Say) -> Opened:
    """The runs in `folders`; one that cannot be opened, or is odd beside the others as `hdrig trace` sees it, is left
    out in words. Raises what the first one is refused with when none can be opened; UsageError for two gears, or a
    torque or an angle that is odd in most; DataError when no run is left, or two assemblies, another gear ratio than
    declared, or two zeros of the motor's encoder."""
    from rig.analysis.identify.recording import recording, refuse_another_ratio
    from rig.analysis.identify.zeros import refuse_other_zeros
    from rig.analysis.motion.held import not_held

    said: list[str] = []

    def tell(sentence: str) -> None:
        said.append(sentence)
        say(sentence)

    runs = _experiments(once(opened(folders, tell), lambda f, why: tell(left_out(f.name, why))), tell)
    _refuse_mixed(_where(folders), runs)
    read = [(one.name, recording(one)) for one in runs]
    found = [r for _, r in read if r is not None]
    out = {r.name: why for r in found if r.locked and (why := not_held(r.theta_l))}
    found = [run for run in found if run.name not in out]
    if not found:
        raise DataError("no run here has time and both angles: nothing to identify from")
    refuse_another_ratio(found)
    out |= _odd([run for run in runs if run.name not in out], _where(folders))
    for name, why in out.items():
        tell(left_out(name, why))
    for name in (name for name, one in read if one is None):
        tell(f"{name} is no part of the fit: it takes time and both angles, 200 rows of them")
    runs = [run for run in runs if run.name not in out]
    found = [run for run in found if run.name not in out]
    if not found:
        raise DataError(f"no run is left to identify from: {'; '.join(said)[:300]}")
    refuse_other_zeros(found)
    said += [*_mixed(runs), *_undeclared(found)]
    said += [f"{run.name}: samples.parquet {why}" for run in runs if (why := changed(run.path, run.manifest))]
    return Opened(runs, found, (*said, *(f"{run.name}: {note}" for run in runs for note in notes(run.misfits))))


def left_out(name: str, why: str) -> str:
    """In words."""
    return f"{name} is left out: {why}"


def _left_out_alike(names: Sequence[str], why: str) -> str:
    """The same of several, in one sentence: a campaign makes a check after every change by hand."""
    if len(names) == 1:
        return left_out(names[0], why)
    more = len(names) - FEW
    listed = f"{', '.join(names[:FEW])} and {more} more" if more > 0 else " and ".join(names)
    return f"{listed} are left out: {why.replace('its ', 'their ', 1)}"


def _experiments(runs: Sequence[Run], tell: Say) -> list[Run]:
    """Those that came to their end; `tell` hears of the others. Raises DataError where there is none."""
    out: dict[str, list[str]] = {}
    found = []
    for run in runs:
        if why := _no_experiment(run):
            out.setdefault(why, []).append(run.name)
        else:
            found.append(run)
    for why, names in out.items():
        tell(_left_out_alike(names, why))
    if not found:
        raise DataError(
            "no completed run of an experiment among these folders, expected one whose manifest has a procedure such "
            f"as constant_torque or kinematic_error: nothing to identify from{_why(out)}"
        )
    return found


def _why(out: Mapping[str, Sequence[str]]) -> str:
    """Of the first of those that are left `out`, by the reason."""
    return next((f" ({names[0]}: {why})" for why, names in out.items()), "")


def _no_experiment(run: Run) -> str:
    """Why nothing is identified from it; "" where something is."""
    if (status := run.manifest.get("status")) not in ("completed", "imported", None):
        return f"its status is {status}, and a run that came to its end is asked for"
    own = run.procedure == "other" and run.manifest.get("label")  # of this program's; another's may be anything
    return "its procedure is no experiment (other)" if own else ""


def _refuse_mixed(name: str, runs: Sequence[Run]) -> None:
    from rig.analysis.motion.one_rig import assembly_of, refuse_other_gears

    refuse_other_gears(name, runs)
    for what, values in (
        ("gear ratios", {run.ratio for run in runs}),
        ("assemblies", {assembly_of(run)[0] for run in runs}),
    ):
        if len(values) > 1:
            words = ", ".join(map(str, sorted(map(str, values))))
            raise DataError(f"these runs are of {len(values)} {what} ({words}): identify one at a time")


def _odd(runs: Sequence[Run], name: str) -> dict[str, str]:
    from rig.analysis.tracing.runs.campaign import odd_runs

    return odd_runs(runs, name)


def _mixed(runs: Sequence[Run]) -> list[str]:
    """What tells that they are not of one rig, or not of one load: the fit has one number for all."""
    from rig.analysis.tracing.runs.mixed import mixed

    return mixed(runs)


def _undeclared(found: Sequence[Recording]) -> list[str]:
    """Of runs in which something hangs on the output that their manifests say nothing of: it counts as drag."""
    from rig.analysis.motion.strokes import find_strokes
    from rig.analysis.turning.weight import other_weight

    told = [(r.name, other_weight(r.source, find_strokes(r.motion), r.tau_l)) for r in found if not r.locked]
    return [f"{name}: {why}" for name, why in told if why]


def _where(folders: Sequence[Path]) -> str:
    """What the runs lie in."""
    return folders[0].resolve().parent.name


def opened(folders: Sequence[Path], say: Say) -> list[Run]:
    """The runs among `folders` that can be opened, and a word for each that cannot. Raises the first refusal where
    there is none."""
    from rig.runfile.run import Run

    runs, refused = [], []
    for folder in folders:
        try:
            runs.append(Run.open(folder))
        except HdrigError as error:
            refused.append((folder, error))
    if not runs and refused:
        raise refused[0][1]
    for folder, why in refused:
        say(left_out(folder.name, said_of(folder, why)))
    return runs
