"""Which runs the fit does not see."""

from __future__ import annotations

import fnmatch
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.tracing.floor import alike, strokes
from rig.analysis.tracing.recording import Recording
from rig.core.errors import UsageError

LEVELS = 4  # of one procedure: with so many, a whole one in the middle can be spared
KEPT = 0.65  # of a run that has no repeat is fitted, the rest held out


@dataclass(frozen=True)
class Split:
    """The runs of the trace (whole ones or parts of them), and which are fitted and held out; standstill is neither."""

    runs: tuple[Recording, ...]
    fitted: tuple[int, ...]
    held_out: tuple[int, ...]
    how: str


def split(runs: Sequence[Recording], asked: Sequence[str]) -> Split:
    """By the names asked for, else whole repeats and levels, else the ends of all runs. Raises UsageError."""
    moving = [i for i, run in enumerate(runs) if run.procedure != "standstill"]
    if asked:
        return _asked(runs, moving, asked)
    groups = grouped(runs, moving)
    if sum(len(group) > 1 for group in groups) * 3 < len(groups):
        return _ends(runs, moving)
    held = _levels_and_repeats(runs, groups)
    fitted = tuple(i for i in moving if i not in held)
    return Split(tuple(runs), fitted, tuple(sorted(held)), "whole repeats, and whole loads and speeds between others")


def _asked(runs: Sequence[Recording], moving: list[int], asked: Sequence[str]) -> Split:
    for pattern in asked:
        if not any(fnmatch.fnmatchcase(run.name, pattern) for run in runs):
            raise UsageError(f"--hold-out {pattern} fits no run; there are {', '.join(r.name for r in runs)[:300]}")
    held = tuple(i for i in moving if any(fnmatch.fnmatchcase(runs[i].name, p) for p in asked))
    fitted = tuple(i for i in moving if i not in held)
    if not fitted or not held:
        raise UsageError(f"--hold-out {' '.join(asked)} leaves {len(fitted)} runs to fit and {len(held)} to test with")
    return Split(tuple(runs), fitted, held, "runs named with --hold-out")


def grouped(runs: Sequence[Recording], moving: Sequence[int]) -> list[list[int]]:
    """Runs of equal condition together, in the order they were taken."""
    groups: list[list[int]] = []
    for i in moving:
        home = next((g for g in groups if alike(runs[g[0]], runs[i])), None)
        if home is None:
            groups.append([i])
        else:
            home.append(i)
    return groups


def _level(run: Recording) -> tuple[float, float]:
    tau_ext = float(run.pieces[0].tau_ext[0])
    return tau_ext, float(np.mean([np.mean(p.omega_m) for p in run.pieces]))


def _levels_and_repeats(runs: Sequence[Recording], groups: list[list[int]]) -> set[int]:
    held: set[int] = set()
    for procedure in sorted({runs[g[0]].procedure for g in groups}):
        mine = sorted((g for g in groups if runs[g[0]].procedure == procedure), key=lambda g: _level(runs[g[0]]))
        whole = mine[len(mine) // 2 - 1] if len(mine) >= LEVELS else None
        others = [g for g in mine if g is not whole]
        held |= set(whole or ())
        repeated = [g for g in others if len(g) > 1]
        # every second condition keeps its repeats in the fit: the floor is measured there
        held |= {g[1] for g in repeated[:: 2 if len(repeated) > 1 else 1]}
    return held


def _ends(runs: Sequence[Recording], moving: list[int]) -> Split:
    """The last third of every run, cut where the motor turns back or has finished a turn."""
    made = list(runs)
    held: list[int] = []
    for i in moving:
        cut = _cut(runs[i])
        if cut is None:
            continue
        piece = runs[i].pieces[0]
        head = replace(runs[i], pieces=(piece.part(slice(0, cut)),))
        tail = replace(runs[i], pieces=(piece.part(slice(cut, None)), *runs[i].pieces[1:]))
        made[i] = head
        made.append(replace(tail, name=f"{runs[i].name} (last part)"))
        held.append(len(made) - 1)
    if not held:
        raise UsageError("no run is long enough to hold a part of it out: at least two turns or strokes are needed")
    return Split(
        tuple(made), tuple(moving), tuple(held), "the last turns or strokes of every run: there are no repeats"
    )


def _cut(run: Recording) -> int | None:
    theta = run.pieces[0].theta_m
    wish = int(KEPT * theta.size)
    parts = strokes(theta)
    if len(parts) >= 2:
        edges = np.array([p.stop for p in parts[:-1]])
        return int(edges[np.argmin(np.abs(edges - wish))])
    turn = int(2 * np.pi / max(1e-9, float(np.mean(np.abs(np.diff(theta))))))
    return turn * (wish // turn) if theta.size > 2 * turn and turn > 0 and wish >= turn else None
