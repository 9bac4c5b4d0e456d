"""The part of a run at constant torque that was meant to be measured: pushed by one torque, and settled."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.strokes import Stroke, find_strokes
from rig.core.numbers import number
from rig.core.units import TURN

SAME = 1e-9  # N·m  asked torques that differ by less are one and the same command
FEWEST = 1.0  # turns that a stretch of constant torque must have to be one
OUTLIER = 5.0  # σ of the later turns' speeds: a turn further out has not settled


@dataclass(frozen=True)
class Window:
    """Rows lo..hi of a motion, and how they were found, one sentence for people."""

    lo: int
    hi: int
    how: str
    torque: float  # N·m, the constant command; NaN where none was recorded
    spread: float  # N·m, greatest less least command within the window; NaN where none was recorded


def part(motion: Motion, lo: int, hi: int) -> Motion:
    """The rows lo..hi of a motion as a motion of its own."""
    rows = np.arange(lo, hi) if motion.rows is None else motion.rows[lo:hi]
    return replace(
        motion,
        theta_m=motion.theta_m[lo:hi],
        theta_l=None if motion.theta_l is None else motion.theta_l[lo:hi],
        t=None if motion.t is None else motion.t[lo:hi],
        rows=rows.astype(np.int64),
        breaks=tuple(b - lo for b in motion.breaks if lo < b < hi),
    )


def measured_window(run: Source, motion: Motion) -> Window:
    """Where the torque was constant and the speed had settled.

    Runs of hdrig: the longest stretch of one and the same `tau_ask` without a `theta_ref`, less the first
    `conditions.settle_s`. Runs of other loggers: all of it, less first turns whose speed is unlike that of the later
    ones. Where the recorded command never stays the same for a turn, all of the run.
    """
    asked = motion.pick(run.column("tau_ask"))
    lo, hi, how = 0, motion.theta_m.size, "all of the run"
    if asked is not None:
        lo, hi, how = _constant(motion, asked, motion.pick(run.column("theta_ref")))
    settle = _seconds(run.conditions.get("settle_s"))
    if settle is not None and motion.t is not None and hi < motion.theta_m.size:
        start = int(np.searchsorted(motion.t, motion.t[lo] + settle))
        if start < hi - 1:
            lo, how = start, f"{how}, less {settle:g} s for the speed to settle"
    else:
        first = _settled(part(motion, lo, hi))
        if first:
            lo, how = lo + first, f"{how}, less the first turns, whose speed had not settled"
    here = np.full(1, np.nan) if asked is None else asked[lo:hi]
    return Window(lo, hi, how, float(np.mean(here)), float(np.ptp(here)))


def _seconds(value: Any) -> float | None:
    found = number(value)
    return found if found >= 0.0 else None


def _constant(motion: Motion, asked: Array, reference: Array | None) -> tuple[int, int, str]:
    """The longest stretch, in turns, of one torque that follows no reference."""
    n = asked.size
    free = np.isfinite(asked) & (True if reference is None else ~np.isfinite(reference))
    step = np.flatnonzero((np.abs(np.diff(asked, prepend=asked[0])) > SAME) | np.diff(free, prepend=free[0]))
    edges = np.unique(np.concatenate(([0], step, [n])))
    turns = np.array(
        [
            abs(motion.theta_m[b - 1] - motion.theta_m[a]) / TURN if free[a] and asked[a] != 0.0 else 0.0
            for a, b in pairwise(edges)
        ]
    )
    best = int(np.argmax(turns))
    if turns[best] < FEWEST:
        return 0, n, "all of the run: the commanded torque is never the same for a whole turn"
    return int(edges[best]), int(edges[best + 1]), "the rows of one constant commanded torque"


def _settled(motion: Motion) -> int:
    """The first row of the longest stroke from which turns are as fast as in its second half; 0 when all are."""
    strokes = find_strokes(motion)
    if not strokes or motion.t is None:
        return 0
    stroke: Stroke = max(strokes, key=lambda s: s.revolutions)
    if stroke.revolutions < 8:
        return 0
    speed = np.diff(motion.theta_m[stroke.edges]) / np.diff(motion.t[stroke.edges])
    late = speed[speed.size // 2 :]
    usual = float(np.median(late))
    spread = max(1.4826 * float(np.median(np.abs(late - usual))), 0.5 * float(np.std(late)))
    quiet = np.abs(speed - usual) <= OUTLIER * spread
    first = int(np.argmax(quiet[:-1] & quiet[1:])) if (quiet[:-1] & quiet[1:]).any() else 0
    return int(stroke.edges[first]) if first else 0
