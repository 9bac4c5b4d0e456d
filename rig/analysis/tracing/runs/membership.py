"""Which runs of a folder belong together, and when each was taken."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from rig.analysis.motion.one_rig import assembly_of
from rig.runfile.run import Run


def one_rig(runs: Sequence[Run]) -> tuple[list[Run], list[str]]:
    """The runs of the assembly most of them were taken in, without attempts that were made again; the rest in words.

    Taking the wave generator out and fitting it again changes the kinematic error: two assemblies are two gears.
    """
    whole, notes = _last_attempts(runs)
    assemblies = Counter(map(assembly_of, whole))
    usual: tuple[Any, ...] = max(assemblies, key=lambda a: assemblies[a]) if assemblies else ()
    others = len(whole) - assemblies[usual]
    if others:
        notes.append(f"{others} runs of other assemblies or depths than {_words(usual)} were left out.")
    return [run for run in whole if assembly_of(run) == usual], notes


def _words(assembly: tuple[Any, ...]) -> str:
    return f"assembly {assembly[0]} at {assembly[1]} mm" if assembly else "the first"


def _last_attempts(runs: Sequence[Run]) -> tuple[list[Run], list[str]]:
    """Of a run that a campaign had to make again the completed one; all others as they are."""
    done = {_place(run) for run in runs if run.manifest.get("status") == "completed"} - {None}
    kept: list[Run] = []
    notes: list[str] = []
    for run in runs:
        status = run.manifest.get("status", "completed")
        if status != "completed" and _place(run) in done:
            notes.append(f"{run.name} ({status}) was left out: the campaign made it again.")
        else:
            kept.append(run)
    return kept, notes


def _place(run: Run) -> tuple[str, int] | None:
    """Campaign and number in it; None for a run of no campaign."""
    about = _campaign(run)
    uid, number = about.get("uid"), about.get("run")
    return (uid, number) if isinstance(uid, str) and isinstance(number, int) else None


def _campaign(run: Run) -> Mapping[str, Any]:
    about = run.manifest.get("campaign")
    return about if isinstance(about, dict) else {}


def starts(runs: Sequence[Run]) -> list[float]:
    """When each run began, s from the first one: by the rig's own time where a campaign says it of all of them.

    In virtual time a run of minutes takes seconds on the wall, and what warms up would seem to do so at once.
    """
    said = [_campaign(run).get("rig_time_s") for run in runs]
    rig = [float(s) for s in said if isinstance(s, int | float)]
    one = len({_campaign(run).get("uid") for run in runs}) == 1
    times = rig if one and len(rig) == len(runs) else [_utc(run) for run in runs]
    known = [t for t in times if t is not None]
    first = min(known, default=0.0)
    return [0.0 if t is None else t - first for t in times]


def _utc(run: Run) -> float | None:
    return run.started.timestamp() if run.started else None
