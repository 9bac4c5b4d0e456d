"""The slow run that a run at speed is compared with: named, or found beside it in the same campaign."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rig.core.errors import HdrigError, UsageError

if TYPE_CHECKING:
    from rig.runfile.run import Run

SLOW = "kinematic_error"
SAME = ("gear", "declared", "encoders", "backend")  # what two runs of one gear on one rig have in common
RIGGED = ("tau_ext", "depth_mm", "assembly")  # conditions that change the kinematic error itself


def reference_named(path: Path) -> Run:
    """The slow run the operator named. Raises UsageError when it is none, DataError when it is damaged."""
    from rig.runfile.run import Run

    run = Run.open(path)
    if run.procedure != SLOW:
        raise UsageError(f"--reference {path}: its procedure is {run.procedure}, expected {SLOW}")
    return run


def reference_beside(run: Run) -> Run | None:
    """The completed slow run of the same gear and rigging, in the folder `run` lies in, nearest to it in time.

    None when there is none: another gear's error would be subtracted without a word.
    """
    return _beside(run, _alike)


def reference_of_one_zero(run: Run) -> Run | None:
    """The same, of the same campaign, from one zero of the motor's encoder: a lock test turns too little to show that
    it was switched off in between, and then the slope of another part of the error would be taken off.

    Of the same session; else of another one, where a proof of the lock test's own session shows the zero to be that of
    the slow run: a campaign that was stopped and taken up again; else of whatever session, where the lock test shows
    it: runs that another program made say nothing of sessions.
    """
    return _beside(run, _one_session) or _of_another_session(run) or _bent_alike(run)


def _bent_alike(run: Run) -> Run | None:
    from rig.analysis.across_runs.wound_up import shown_by_windup
    from rig.analysis.kinematic_error.reference import kinematic_error_reference
    from rig.analysis.motion.tame import Tame

    slow = _beside(run, _alike)
    series = None if slow is None else kinematic_error_reference(Tame(slow))
    return slow if series is not None and shown_by_windup(Tame(run), series) else None


def _of_another_session(run: Run) -> Run | None:
    slow = _beside(run, _one_campaign)
    if slow is None:
        return None
    from rig.analysis.across_runs.one_zero import shown_common, zero_between
    from rig.analysis.kinematic_error.reference import kinematic_error_reference
    from rig.analysis.motion.tame import Tame

    series = kinematic_error_reference(Tame(slow))
    if series is None:
        return None
    return slow if any(shown_common(zero_between(Tame(check), series)) for check in _checks(run)) else None


def _checks(run: Run) -> Iterator[Run]:
    """Proofs and weighings of the session `run` is of."""
    return _runs(run.path.resolve().parent / "checks", lambda about: _same_session(run.manifest, about))


def _beside(run: Run, fits: Callable[[Mapping[str, Any], Mapping[str, Any]], bool]) -> Run | None:
    here = run.path.resolve().parent
    found = [
        other for other in _runs(here, lambda about: fits(run.manifest, about)) if other.path.name != run.path.name
    ]
    return min(found, key=lambda other: _apart(run, other)) if found else None


def _runs(folder: Path, fits: Callable[[Mapping[str, Any]], bool]) -> Iterator[Run]:
    """Those directly in `folder` whose manifest `fits`, as they are named."""
    from rig.runfile import manifest
    from rig.runfile.misfits import usable
    from rig.runfile.run import Run

    for path in sorted(folder.glob(f"*/{manifest.NAME}")):
        try:
            if fits(usable(manifest.read(path.parent))):
                yield Run.open(path.parent)
        except HdrigError:  # somebody else's folder, or a damaged one: not the one to compare with
            continue


def _apart(run: Run, other: Run) -> float:
    """s between the starts of two runs; 0 where one does not say."""
    if run.started is None or other.started is None or (run.started.tzinfo is None) != (other.started.tzinfo is None):
        return 0.0
    return abs((run.started - other.started).total_seconds())


def _one_session(run: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    return _same_session(run, other) and _alike(run, other)


def _one_campaign(run: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    return _shared(run, other, "uid") and _alike(run, other)


def _same_session(run: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    return _shared(run, other, "uid") and _shared(run, other, "session")


def _shared(run: Mapping[str, Any], other: Mapping[str, Any], key: str) -> bool:
    """Whether both are said to be of one campaign, or of one session of it."""
    mine, theirs = run.get("campaign") or {}, other.get("campaign") or {}
    return bool(mine.get(key)) and mine.get(key) == theirs.get(key)


def _alike(run: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    mine, theirs = run.get("conditions") or {}, other.get("conditions") or {}
    rigged = all((mine.get(key) or 0) == (theirs.get(key) or 0) for key in RIGGED)
    same = all(run.get(key) == other.get(key) for key in SAME)
    done = other.get("status", "completed") in ("completed", "imported")
    return rigged and same and done and str(other.get("procedure")).replace("-", "_") == SLOW
