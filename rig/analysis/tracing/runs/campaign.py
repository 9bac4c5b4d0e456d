"""A folder of runs → recordings; what cannot be used is said, and is fatal only when nothing remains."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rig.analysis.motion.held import not_held
from rig.analysis.motion.one_rig import refuse_other_gears
from rig.analysis.tracing.runs.added import with_discs
from rig.analysis.tracing.runs.balance import odd_balances
from rig.analysis.tracing.runs.clocked import rate_by_speed, said_of
from rig.analysis.tracing.runs.look import FIRST, Look
from rig.analysis.tracing.runs.membership import one_rig, starts
from rig.analysis.tracing.runs.mixed import mixed
from rig.analysis.tracing.runs.motor_zero import other_zeros
from rig.analysis.tracing.runs.odd_torques import odd_torques
from rig.analysis.tracing.runs.record import record
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.rigid import no_spring, unweighed_inertia
from rig.analysis.tracing.runs.same_rows import same_rows
from rig.analysis.tracing.runs.told_once import Said, left_out, told_once
from rig.analysis.tracing.runs.turned import swings_alone, too_short
from rig.analysis.tracing.runs.unfinished import unfinished
from rig.analysis.tracing.runs.units import faster_by_degrees, odd_angles, refuse_odd_angles
from rig.analysis.tracing.runs.unweighed import weighed
from rig.analysis.tracing.runs.weights import other_weights, refuse_odd_torques
from rig.core.errors import DataError, Exit, HdrigError, UsageError
from rig.model.effect import Moved
from rig.process.workers import WORKERS
from rig.runfile.copies import once
from rig.runfile.doubt import changed
from rig.runfile.manifest import Missing, is_nameless
from rig.runfile.run import Run

DAY = "[0-9][0-9][0-9][0-9]-[0-9][0-9]-[0-9][0-9]"  # a folder of the runs of one day
LEANT_ON = {"t": "time column that increases", "theta_m": "θ_m", "theta_l": "θ_l", "tau_l": "τ_l"}
"""Channels that something stands in for where they were not measured, in words."""


@dataclass(frozen=True)
class Campaign:
    """Runs of one rig in one assembly, in the order they were taken."""

    name: str
    folder: Path
    runs: tuple[Recording, ...]
    simulated: bool
    notes: tuple[str, ...]
    left_out: tuple[str, ...] = ()  # folders with samples or a manifest that are none of the runs


def looking(campaign: Campaign, looks: Sequence[Look]) -> Campaign:
    """The same runs, each looked at as said."""
    runs = tuple(replace(run, look=look) for run, look in zip(campaign.runs, looks, strict=True))
    return replace(campaign, runs=runs)


def folders_of_runs(folder: Path) -> list[Path]:
    """Those directly in `folder`, or in its days, as `hdrig import` lays them. Raises UsageError without any,
    and for a folder that nobody may look into."""
    if not folder.is_dir():
        raise UsageError(f"{folder} is no folder: expected a campaign, a folder of run folders")
    if not os.access(folder, os.R_OK | os.X_OK):
        raise UsageError(f"{folder} cannot be read: permission denied")
    places = sorted(path.parent for path in folder.glob("*/manifest.json"))
    if not places and (folder / "manifest.json").is_file():
        raise UsageError(f"{folder} is a run: expected a campaign, the folder of runs it lies in")
    if not places:
        places = sorted(path.parent for path in folder.glob(f"{DAY}/*/manifest.json"))
    if not places:
        deeper = sorted({path.parent.parent.name for path in folder.glob("[!.]*/*/manifest.json")})
        hint = f"; {deeper[-1]} in it does" if deeper else ""
        raise UsageError(f"{folder} holds no run: expected folders, each with a manifest.json{hint}")
    return places


def read_campaign(folder: Path, look: Look = FIRST) -> Campaign:
    """All run folders directly in `folder`, each looked at as said. Raises UsageError when it holds no run with an
    angle, DataError where that is because all are damaged."""
    places, name = folders_of_runs(folder), folder.resolve().name  # that of `.` is empty
    opened, out = _open(places)
    opened = once(opened, lambda copy, why: out.append(left_out(copy.name, why)))
    nameless = [*_nameless(folder, places), *_closed(folder)]
    out += nameless
    opened, unfit = one_rig(opened)
    refuse_other_gears(name, opened)
    begun = starts(opened)
    with ThreadPoolExecutor(WORKERS) as pool:
        hz = rate_by_speed(opened)
        found = list(pool.map(lambda run, start: _record(run, start, hz, look), opened, begun))
    out += [r for r in found if isinstance(r, Said)]
    runs = [r for r in found if isinstance(r, Recording)]
    refuse_odd_angles(runs, name)
    for sort in (_copies, _odd, _swings_alone, _lacking, _same_gear, _odd_torques, _odd_balances):
        runs, odd = sort(runs)
        out += odd
    runs, discs = with_discs(runs)
    runs, carrying = weighed(runs)
    out += [*carrying, *other_weights(runs)]
    clocked = [r for r in runs if r.clocked]
    unfit += [said_of(len(clocked), len(runs) - len(clocked), hz)] if hz is not None and clocked else []
    part = unfinished(folder)
    said = told_once([*(Said(r.name, "", note) for r in runs for note in r.notes), *out, *other_zeros(runs)])
    notes = [*([part] if part else []), *unfit, *mixed(opened, discs), *said]
    if not runs:
        kind = DataError if all(said.damaged for said in out if said.became) else UsageError
        raise kind(f"{folder}: none of its {len(places)} runs can be used: {' '.join(notes)[:300]}")
    runs = _same_sensors(sorted(runs, key=lambda r: (r.start, r.name)))
    if no_spring(runs):
        runs = [replace(run, look=replace(run.look, rigid=True)) for run in runs]
    if unweighed_inertia(runs):
        runs = [replace(run, look=replace(run.look, inertia=True)) for run in runs]
    left = {place.name for place in places} | {said.run for said in nameless}
    left -= {run.name for run in runs}
    return Campaign(
        name, folder, _with_past(runs), any(run.simulated for run in opened), tuple(notes), tuple(sorted(left))
    )


def read_again(first: Campaign, **changed: Any) -> Campaign | None:
    """The same runs, read once more and looked at as before but for what is `changed` of the looks; None where these
    are others now, or cannot be read so: what was told of them stands."""
    try:
        again = read_campaign(first.folder, replace(first.runs[0].look, **changed))
    except UsageError:
        return None
    same = [run.name for run in again.runs] == [run.name for run in first.runs]
    return looking(again, [replace(run.look, **changed) for run in first.runs]) if same else None


def odd_runs(runs: Sequence[Run], name: str) -> dict[str, str]:
    """Why some of `runs` do not go with the others of the campaign `name`, by the run's name: other units of time,
    angle or torque, other signs, another ratio. What cannot be told of a run is no reason. Raises UsageError where
    most are so.
    """
    read = [_read(*one) for one in zip(runs, starts(runs), strict=True)]
    out = [r for r in read if isinstance(r, Said)]
    found = [r for r in read if isinstance(r, Recording) and not _unfit(r)]
    refuse_odd_angles(found, name)
    for sort in (_copies, _odd, _same_gear, _odd_torques, _odd_balances):
        found, odd = sort(found)
        out += odd
    refuse_odd_torques(found, name)
    return {said.run: said.reason for said in out}


def _open(places: list[Path]) -> tuple[list[Run], list[Said]]:
    opened: list[Run] = []
    out: list[Said] = []
    for place in places:
        try:
            opened.append(Run.open(place))
        except HdrigError as error:
            out.append(_unopened(place, error))
    return opened, out


def _nameless(folder: Path, places: Sequence[Path]) -> list[Said]:
    """Folders beside the runs with samples that no manifest says anything of."""
    beside = sorted({folder, *(place.parent for place in places)})
    there = [p for parent in beside for p in sorted(parent.glob("[!.]*")) if is_nameless(p)]
    return [_unopened(p, Missing(p / "manifest.json")) for p in there]


def _unopened(place: Path, error: HdrigError) -> Said:
    """Why a folder is none of the runs; an `error` of a place that nobody may read is no damage."""
    why = str(error).replace(f"{place}/", "").replace(str(place), "it")
    return left_out(place.name, why, error.exit is Exit.INCOMPLETE)


def _closed(folder: Path) -> list[Said]:
    """Folders nobody may look into: whether they hold a run is not known."""
    closed = [p.name for p in sorted(folder.iterdir()) if p.is_dir() and not _opens(p)]
    return [left_out(name, "it cannot be read: permission denied") for name in closed]


def _opens(folder: Path) -> bool:
    """Whether it can be looked into: what a system would allow, and what it does, are not always the same."""
    try:
        os.listdir(folder)
    except PermissionError:
        return False
    return os.access(folder, os.X_OK)


def _record(run: Run, start: float, hz: float | None = None, look: Look = FIRST) -> Recording | Said:
    """What the tracer reads of `run`, or why it cannot use it."""
    made = _read(run, start, hz, look)
    if isinstance(made, Said):
        return made
    if why := _unfit(made):
        return left_out(run.name, why)
    said = changed(run.path, run.manifest)  # somebody may have put something in on purpose: told, and read
    return replace(made, notes=(*made.notes, f"samples.parquet {said}")) if said else made


def _read(run: Run, start: float, hz: float | None = None, look: Look = FIRST) -> Recording | Said:
    """`run` as read, or why nothing can be read of it, whatever for: the rule of traces and of identification."""
    try:
        return record(run, start, hz, look)
    except (HdrigError, ValueError) as error:
        return left_out(run.name, error, isinstance(error, DataError))


def _unfit(made: Recording) -> str:
    """Why a run that can be read is none for a trace; "" where it is one."""
    if not made.pieces:
        return "it has no stretch without a gap that is long enough for the low-pass, some tenths of a second"
    if made.locked and not made.input_locked and (why := _gave_way(made)):
        return why
    if said := too_short(made):
        odd = odd_angles(made)
        return f"{said}; {odd}" if odd else said
    return ""


def _gave_way(run: Recording) -> str:
    """Why this is no lock test, by the load angle as read; "" where it was not, or did not move."""
    read = [p.theta_l for p in run.pieces] if "theta_l" in run.has else []
    return next((why for angle in read if (why := not_held(angle))), "")


def _odd(runs: list[Recording]) -> tuple[list[Recording], list[Said]]:
    """Runs whose angles are not what the others' are are left out."""
    return _apart(runs, faster_by_degrees(runs) | {r.name: said for r in runs if (said := odd_angles(r)) is not None})


def _copies(runs: list[Recording]) -> tuple[list[Recording], list[Said]]:
    """Of runs with the same rows all but the first are left out."""
    return _apart(runs, same_rows(runs))


def _swings_alone(runs: list[Recording]) -> tuple[list[Recording], list[Said]]:
    """Runs that swing by less than a turn are left out where no other has the kinematic error."""
    return _apart(runs, swings_alone(runs))


def _odd_torques(runs: list[Recording]) -> tuple[list[Recording], list[Said]]:
    """Runs whose torque is read otherwise than that of the others are left out."""
    return _apart(runs, odd_torques(runs))


def _odd_balances(runs: list[Recording]) -> tuple[list[Recording], list[Said]]:
    """Runs in which a torque is none that friction, weight and spring allow are left out."""
    return _apart(runs, odd_balances(runs))


def _apart(runs: list[Recording], wrong: Mapping[str, str]) -> tuple[list[Recording], list[Said]]:
    """The runs but for those that are `wrong`, by name, and why those are."""
    return [r for r in runs if r.name not in wrong], [left_out(name, said) for name, said in wrong.items()]


def _lacking(runs: list[Recording]) -> tuple[list[Recording], list[Said]]:
    """A run that lacks what most of its kind have is left out: what stands in for it would count as measured.

    Not one without a motor torque, which nothing stands in for.
    """
    wrong: dict[str, str] = {}
    for kind in (False, True):
        mine = [r for r in runs if r.locked is kind and r.procedure != "standstill"]
        for name, words in LEANT_ON.items():
            if name == "t" and any(r.clocked for r in mine):
                continue  # nobody has a time of its own
            without = [r for r in mine if name not in r.knows]
            if 2 * len(without) < len(mine):
                said = f"it has no {words}, which {len(mine) - len(without)} of {len(mine)} runs of its kind have"
                wrong |= {r.name: "; ".join([said, *_of_channel(r, name)]) for r in without}
    return _apart(runs, wrong)


def _of_channel(run: Recording, name: str) -> list[str]:
    """What was noted of a channel when the run was read: why it has none."""
    return [note.rstrip(".") for note in run.notes if name != "t" and note.startswith(name)]


def _same_sensors(runs: list[Recording]) -> list[Recording]:
    """A sensor is as noisy in every run; where a reading looks rougher than in the smoothest run, it really moved."""
    turning = [r for r in runs if r.procedure != "standstill" and not r.locked]
    least: dict[str, float] = {}
    for run in turning:
        for name, rms in run.noise.items():
            raw = rms * run.thinned**0.5
            least[name] = min(raw, least.get(name, raw))
    return [
        replace(run, noise={n: min(rms, least.get(n, rms) / run.thinned**0.5) for n, rms in run.noise.items()})
        for run in runs
    ]


def _with_past(runs: list[Recording]) -> tuple[Recording, ...]:
    """Every run with what all of them did: friction that warms a drive leaves its heat to the next run."""
    past = tuple(_moved(run) for run in runs)
    return tuple(replace(run, pieces=tuple(replace(p, past=past) for p in run.pieces)) for run in runs)


def _moved(run: Recording) -> Moved:
    omega = np.concatenate([p.omega_m for p in run.pieces])
    start, end = float(run.pieces[0].t[0]), float(run.pieces[-1].t[-1])
    return Moved(start, end, float(np.mean(np.abs(omega))), float(np.mean(omega**2)))


def _same_gear(runs: list[Recording]) -> tuple[list[Recording], list[Said]]:
    """A campaign is one rig: runs of another ratio than most are left out."""
    if not runs:
        return runs, []
    ratios, counts = np.unique([r.ratio for r in runs], return_counts=True)
    usual = float(ratios[np.argmax(counts)])
    odd = [left_out(r.name, f"ratio {r.ratio:g}, the others have {usual:g}") for r in runs if r.ratio != usual]
    return [r for r in runs if r.ratio == usual], odd
