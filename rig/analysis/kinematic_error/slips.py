"""Steps of θ̃ that stay: counts an encoder lost, or a hub or coupling that slipped. No gear does that.

Every revolution is held against the mean of those of its direction: what comes again every turn drops out, and a step
is where the mean of the next sixteenth of a turn differs from that of the last.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.motion.strokes import Index, Stroke
from rig.analysis.orders.revolutions import GRID, StrokeResult
from rig.core.units import TURN

WINDOW: Final = GRID // 16  # points of either side
LASTING: Final = 6 * WINDOW  # points of either side that must be apart as well, where there are so many
FAR: Final = 10.0  # σ of what neighbouring windows differ by: wander of a load and of friction included
LEAST: Final = 3.0  # arcsec: less is no slip that anybody looks for in one run
BESIDE: Final = 0.2  # of the largest: what the trend and the mean turn make of it is less
STAYS: Final = 0.5  # of the step, which the longer stretches must be apart by: the trend that was taken off leans on it
SLOWER: Final = 1.02  # times as long as usual for a sixteenth of a turn: a ramp of the speed is over by then
NEAR: Final = 2 * WINDOW * TURN / GRID  # rad
SHADOW: Final = 1.5  # times what a slip leaves in the mean turn: the trend that is taken off shares in it
TOLD: Final = 3  # slips told one by one
SIGMA: Final = 1.4826  # of normal noise, over its median size


@dataclass(frozen=True)
class Slip:
    """A step of `size` arcsec ± `half` at the row `row` of the motion."""

    row: int
    size: float
    half: float
    angle: float = 0.0  # rad of the motor
    turns: int = 0  # in its direction, it among them
    direction: int = 0

    def words(self, motion: Motion) -> str:
        """ "by 40.2 ± 1.1 arcsec at t = 33.30 s"."""
        at = f"row {self.row}" if motion.t is None else f"t = {motion.t[self.row]:.2f} s"
        return f"by {self.size:.1f} ± {self.half:.1f} arcsec at {at}".replace("-", "−")


def slipped(motion: Motion, strokes: Sequence[Stroke], results: Sequence[StrokeResult]) -> str:
    """Where θ̃ steps and stays, "" where it does not: the zero of an angle is another one from there on, so no limit is
    met or missed."""
    slips = find_slips(motion, strokes, results)
    if not slips:
        return ""
    told = " and ".join(slip.words(motion) for slip in slips[:TOLD])
    more = f" and {len(slips) - TOLD} more times" if len(slips) > TOLD else ""
    return f"θ̃ steps {told}{more} and stays there: an encoder lost counts, or a hub or coupling slipped."


def find_slips(motion: Motion, strokes: Sequence[Stroke], results: Sequence[StrokeResult]) -> list[Slip]:
    """Steps within strokes, in order of time; none where a direction has a single revolution."""
    rests = [
        _rest(float(motion.theta_m[s.edges[0]]), r, results, _steady(motion, s))
        for s, r in zip(strokes, results, strict=True)
    ]
    apart = [None if rest is None else _apart(rest.left, WINDOW) for rest in rests]
    known = [a for a in apart if a is not None and a.size]
    if not known:
        return []
    sigma = SIGMA * float(np.median(np.abs(np.concatenate(known))))
    least = max(FAR * sigma, LEAST, BESIDE * max(float(np.abs(a).max()) for a in known))
    found = []
    for stroke, result, rest, a in zip(strokes, results, rests, apart, strict=True):
        if rest is None or a is None:
            continue
        turns = sum(len(r.curves) for r in results if r.direction == result.direction)
        for at, size in _steps(rest.left, a, least):
            row = _row(motion, stroke, rest.first + at)
            found.append(Slip(row, size, 2 * sigma, float(motion.theta_m[row]), turns, result.direction))
    return sorted((one for one in found if not any(_is_shadow(one, of) for of in found)), key=lambda slip: slip.row)


def _is_shadow(one: Slip, of: Slip) -> bool:
    """Whether it is what another slip leaves in the mean turn, by which all other turns seem to step back at its angle:
    of six turns a fifth of it."""
    if one.direction != of.direction or one.size * of.size >= 0 or of.turns < 2:
        return False
    apart = abs((one.angle - of.angle + TURN / 2) % TURN - TURN / 2)
    return apart < NEAR and abs(one.size) < SHADOW * abs(of.size) / (of.turns - 1)


@dataclass(frozen=True)
class _Rest:
    """θ̃ along a stroke less what comes again every turn, (n,) arcsec, from its point `first` on."""

    left: Array
    first: int


def _rest(
    start: float, result: StrokeResult, all_of_them: Sequence[StrokeResult], steady: tuple[int, int]
) -> _Rest | None:
    """Of the `steady` points of a stroke, as it was gone through from `start` rad of the motor on."""
    same = np.concatenate([r.curves for r in all_of_them if r.direction == result.direction])
    if len(same) < 2:
        return None
    first = int(start / TURN % 1.0 * GRID)
    rest = np.roll(result.curves - np.mean(same, axis=0), -first, axis=1)
    rest *= len(same) / (len(same) - 1)  # a step is in the mean as well
    along = np.asarray((rest if result.direction > 0 else np.roll(rest, -1, axis=1)[:, ::-1]).ravel())
    return _Rest(along[slice(*steady)], steady[0])


def _steady(motion: Motion, stroke: Stroke) -> tuple[int, int]:
    """The points of a stroke between its run-up and its run-down, (first, one past the last): an inertia that gains
    speed winds the gear up, and lets go of it at once when the speed is reached."""
    rows = _rows(motion, stroke, np.arange(0, stroke.revolutions * GRID + 1, WINDOW))
    took = np.diff(rows if motion.t is None else motion.t[rows])
    at_speed = np.flatnonzero(took < SLOWER * np.median(took))
    if at_speed.size < 2:
        return 0, stroke.revolutions * GRID
    return int(at_speed[0] + 1) * WINDOW, int(at_speed[-1]) * WINDOW  # the first and the last may have an end of a ramp


def _apart(rest: Array, window: int) -> Array:
    """By how much the `window` points after each place differ in the mean from those before, (n − 2·window + 1,)."""
    if rest.size < 2 * window:
        return np.empty(0)
    total = np.concatenate([[0.0], np.cumsum(rest)])
    mean = (total[window:] - total[:-window]) / window
    return np.asarray(mean[window:] - mean[:-window])


def _steps(rest: Array, apart: Array, least: float) -> list[tuple[int, float]]:
    """Places in `rest` and sizes of its steps, largest first, each well away from the others."""
    left, found = np.abs(apart), []
    while left.size and left.max() > least:
        at = int(np.argmax(left))
        left[max(at - 2 * WINDOW, 0) : at + 2 * WINDOW] = 0.0
        size, place = float(apart[at]), at + WINDOW
        before, after = rest[max(place - LASTING, 0) : place], rest[place : place + LASTING]
        sized = _sized(before, after)
        if float(np.median(after) - np.median(before)) / size > STAYS and abs(sized) > LEAST:
            found.append((place, sized))
    return found


def _sized(before: Array, after: Array) -> float:
    """The step between two stretches that lie on one slope otherwise."""
    x = np.arange(before.size + after.size) / LASTING
    columns = np.stack([np.ones(x.size), x, x >= before.size / LASTING], 1)
    return float(np.linalg.lstsq(columns, np.concatenate([before, after]), rcond=None)[0][2])


def _row(motion: Motion, stroke: Stroke, place: int) -> int:
    """The row of a place along a stroke's revolutions."""
    return int(_rows(motion, stroke, np.array([place]))[0])


def _rows(motion: Motion, stroke: Stroke, places: Index) -> Index:
    """Rows at which the motor comes by some places of a stroke."""
    first, last = int(stroke.edges[0]), int(stroke.edges[-1])
    theta = motion.theta_m[first : last + 1]
    gone = np.maximum.accumulate(stroke.direction * (theta - theta[0]))
    return np.asarray(first + np.minimum(np.searchsorted(gone, places * (TURN / GRID)), last - first))
