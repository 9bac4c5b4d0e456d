"""The slow run that a run at speed is compared with: named, or found beside it in the same campaign."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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
    """The same, of the same session of the same campaign: a lock test turns too little to show that the motor's encoder
    was switched off in between, and then the slope of another part of the error would be taken off.
    """
    return _beside(run, _one_zero)


def _beside(run: Run, fits: Callable[[Mapping[str, Any], Mapping[str, Any]], bool]) -> Run | None:
    from rig.runfile import manifest
    from rig.runfile.run import Run

    found: list[Run] = []
    for path in sorted(run.path.resolve().parent.glob(f"*/{manifest.NAME}")):
        try:
            if path.parent.name != run.path.name and fits(run.manifest, manifest.read(path.parent)):
                found.append(Run.open(path.parent))
        except HdrigError:  # somebody else's folder, or a damaged one: not the one to compare with
            continue
    return min(found, key=lambda other: _apart(run, other)) if found else None


def _apart(run: Run, other: Run) -> float:
    """s between the starts of two runs; 0 where one does not say."""
    if run.started is None or other.started is None or (run.started.tzinfo is None) != (other.started.tzinfo is None):
        return 0.0
    return abs((run.started - other.started).total_seconds())


def _one_zero(run: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    mine, theirs = run.get("campaign") or {}, other.get("campaign") or {}
    one = all(mine.get(key) == theirs.get(key) for key in ("uid", "session"))
    return bool(mine.get("uid")) and one and _alike(run, other)


def _alike(run: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    mine, theirs = run.get("conditions") or {}, other.get("conditions") or {}
    rigged = all((mine.get(key) or 0) == (theirs.get(key) or 0) for key in RIGGED)
    same = all(run.get(key) == other.get(key) for key in SAME)
    done = other.get("status", "completed") in ("completed", "imported")
    return rigged and same and done and str(other.get("procedure")).replace("-", "_") == SLOW
