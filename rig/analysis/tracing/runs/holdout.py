"""Which runs the fit does not see."""

from __future__ import annotations

import fnmatch
import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.tracing.runs.alike import alike
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.strokes import strokes, wound_back
from rig.core.errors import UsageError
from rig.core.nearest import nearest
from rig.core.units import TURN
from rig.model.effect import Array, Signals

LEVELS = 4  # of one procedure: with so many, a whole one in the middle can be spared
KEPT = 0.65  # of a run that has no repeat is fitted, the rest held out
SPARED = 3  # one stretch of so many is held out
FORTH_AND_BACK = 2  # strokes
TURNED_BACK = 0.7  # of a stroke: what is left of it goes with the next, so that both ways are tested
PAIRS = 8  # of strokes, from which on every third tells of all
MIXED = 2.0  # highest speed of strokes over the lowest: a motion that is repeated has one
STAIR = 3  # strokes for one of a gear that is wound up and down: with more the motor sticks
WOUND = 0.3  # of the range of a locked run's angle, by which it goes back after it was wound up
STRETCH = 150  # rows: ten times what filters and friction leave out at its ends
HELD_PART = "part held out"
TOLD = 8  # names of runs in a sentence
TOO_SHORT = "no run is long enough to hold a part of it out: at least two turns or strokes of the motor are needed"


@dataclass(frozen=True)
class Split:
    """The runs of the trace (whole ones or parts of them), and which are fitted and held out; standstill is neither."""

    runs: tuple[Recording, ...]
    fitted: tuple[int, ...]
    held_out: tuple[int, ...]
    how: str

    @property
    def unseen(self) -> tuple[int, ...]:
        """Runs of which no part was fitted: what a run has to itself, such as its zero, shows in any part of it."""
        fitted = {whole_run(self.runs[i].name) for i in self.fitted}
        return tuple(i for i in self.held_out if whole_run(self.runs[i].name) not in fitted)


def split(runs: Sequence[Recording], asked: Sequence[str], swapped: bool = False) -> Split:
    """By the names asked for, else whole repeats and levels, else parts of all runs; `swapped`: repeats of those
    conditions whose repeats would stay in the fit. Raises UsageError."""
    moving = [i for i, run in enumerate(runs) if run.procedure != "standstill"]
    if not moving:
        raise UsageError("there is nothing but standstill: expected runs in which the motor turns")
    if asked:
        return _asked(runs, moving, asked)
    groups = grouped(runs, moving)
    if sum(len(group) > 1 for group in groups) * 3 < len(groups):
        return _parts(runs, moving)
    held = _levels_and_repeats(runs, groups, swapped)
    fitted = tuple(i for i in moving if i not in held)
    tested = {runs[i].procedure for i in held}
    made, parts = _parted(runs, [i for i in fitted if runs[i].procedure not in tested])
    how = "whole repeats, and whole loads and speeds between others"
    if parts:
        how += "; of what was done only once a third, whole turns or strokes"
    return Split(made, fitted, (*sorted(held), *parts), how)


def whole_run(name: str) -> str:
    """The name of the run that the one of this name is, or is a part of."""
    return name.removesuffix(f" ({HELD_PART})")


def refuse_unmatched(names: Sequence[str], asked: Sequence[str]) -> None:
    """Raises UsageError when one of the patterns `asked` for names no run; says nothing where there are no `names`."""
    for pattern in asked:
        if names and not any(fnmatch.fnmatchcase(name, pattern) for name in names):
            raise UsageError(f"--hold-out '{pattern}' fits none of the {len(names)} runs; {_some_of(pattern, names)}")


def _some_of(pattern: str, names: Sequence[str]) -> str:
    """What was meant, or the first names and how many more the campaign's folder holds."""
    said = nearest(pattern, names)
    if said.startswith("did"):
        return said
    more = f" and {len(names) - TOLD} more in the campaign's folder" if len(names) > TOLD else ""
    return f"expected one of {', '.join(sorted(names)[:TOLD])}{more}"


def _asked(runs: Sequence[Recording], moving: list[int], asked: Sequence[str]) -> Split:
    refuse_unmatched([run.name for run in runs], asked)
    held = tuple(i for i in moving if any(fnmatch.fnmatchcase(runs[i].name, p) for p in asked))
    fitted = tuple(i for i in moving if i not in held)
    if not fitted or not held:
        raise UsageError(
            f"--hold-out {' '.join(asked)} leaves {len(fitted)} of {len(moving)} runs to fit and {len(held)} to test "
            "with; expected at least one of each"
        )
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
    """How far it was wound up where the motor is locked, else the weight and the speed."""
    if run.input_locked:
        return max(float(np.ptp(p.torque)) for p in run.pieces), 0.0
    tau_ext = float(run.pieces[0].tau_ext[0])
    return tau_ext, float(np.mean([np.mean(p.omega_m) for p in run.pieces]))


def _levels_and_repeats(runs: Sequence[Recording], groups: list[list[int]], swapped: bool) -> set[int]:
    held: set[int] = set()
    by_time = sorted((i for g in groups for i in g), key=lambda i: runs[i].start)
    ends = {by_time[0], by_time[-1]}  # what drifts would be foretold for a time that no fitted run reaches
    for procedure in sorted({runs[g[0]].procedure for g in groups}):
        mine = sorted((g for g in groups if runs[g[0]].procedure == procedure), key=lambda g: _level(runs[g[0]]))
        middle = len(mine) // 2 - 1
        spare = [k for k in range(1, len(mine) - 1) if not ends & set(mine[k])] if len(mine) >= LEVELS else []
        whole = mine[min(spare, key=lambda k: abs(k - middle))] if spare else None
        others = [g for g in mine if g is not whole]
        held |= set(whole or ())
        repeated = [g for g in others if len(g) > 1]
        # every second condition keeps its repeats in the fit: the floor is measured there
        held |= {
            g[0] if g[1] in ends else g[1] for g in (repeated[int(swapped) :: 2] if len(repeated) > 1 else repeated)
        }
    return held


def _parts(runs: Sequence[Recording], moving: list[int]) -> Split:
    made, held = _parted(runs, moving)
    if not held:
        raise UsageError(TOO_SHORT)
    how = "a third of every run, whole turns or strokes: there are too few repeats to hold whole runs out"
    return Split(made, tuple(moving), held, how)


def _parted(runs: Sequence[Recording], chosen: Sequence[int]) -> tuple[tuple[Recording, ...], tuple[int, ...]]:
    """The runs with a third of each chosen one as a run of its own behind the others, and where those are: every third
    stretch of one that turns on and on or that goes forth and back at many speeds, else the last turns or strokes."""
    made, held = list(runs), []
    for i in chosen:
        parts = _stretches(runs[i]) or _here_and_there(runs[i]) or _head_and_tail(runs[i])
        if parts is None:
            continue
        made[i] = replace(runs[i], pieces=parts[0])
        made.append(replace(runs[i], pieces=parts[1], name=f"{runs[i].name} ({HELD_PART})"))
        held.append(len(made) - 1)
    return tuple(made), tuple(held)


Parts = tuple[tuple[Signals, ...], tuple[Signals, ...]]


def _stretches(run: Recording) -> Parts | None:
    """Whole turns of the motor, long against the filters, every third stretch of them to test with.

    Cut off at its end, a run of one turn of the output or less would be tested at output angles it was not fitted at,
    and one stroke forth and back would be fitted one way and tested the other.
    """
    stretches = [s for piece in run.pieces for s in _whole_turns(piece)]
    if len(stretches) < SPARED + 1:
        return None
    held = range(SPARED // 2, len(stretches), SPARED)
    return tuple(s for j, s in enumerate(stretches) if j not in held), tuple(stretches[j] for j in held)


def _whole_turns(piece: Signals) -> list[Signals]:
    theta, ways = np.abs(piece.theta_m - piece.theta_m[0]), strokes(piece.theta_m)
    if len(ways) == FORTH_AND_BACK:
        return [turn for way in ways for turn in _whole_turns(piece.part(way))]
    if len(ways) != 1 or theta[-1] < TURN:
        return []
    rows = max(1.0, theta.size * TURN / theta[-1])
    turns = int(np.ceil(STRETCH / rows))
    marks = np.arange(0.0, theta[-1], TURN * turns)
    edges = [*np.searchsorted(np.maximum.accumulate(theta), marks), theta.size]
    cut = [slice(int(lo), int(hi)) for lo, hi in itertools.pairwise(edges)]
    return [piece.part(rows) for rows in cut if rows.stop - rows.start > STRETCH / 2]


def _here_and_there(run: Recording) -> Parts | None:
    """Strokes of many speeds, as in the log of a machine at work, every third pair of them to test with: its end alone
    may be faster than all before. Cut where the motor turns, for friction remembers where it turned back; the spring of
    a locked run remembers all of its strokes."""
    pairs = [] if run.locked else [pair for piece in run.pieces for pair in _pairs(piece)]
    if len(pairs) < PAIRS:
        return None
    speeds = [float(np.mean(np.abs(pair.omega_m))) for pair in pairs]
    if np.percentile(speeds, 90) < MIXED * np.percentile(speeds, 10):
        return None
    held = range(SPARED // 2, len(pairs), SPARED)
    return tuple(pair for j, pair in enumerate(pairs) if j not in held), tuple(pairs[j] for j in held)


def _pairs(piece: Signals) -> list[Signals]:
    """A stroke and the next, each from well within one stroke on, and as long as a stretch at least."""
    ways = strokes(piece.theta_m)
    within = [
        way.start + int(TURNED_BACK * (way.stop - way.start)) for way in ways[FORTH_AND_BACK - 1 :: FORTH_AND_BACK]
    ]
    edges = [0]
    for cut in within:
        if min(cut - edges[-1], piece.theta_m.size - cut) >= STRETCH:
            edges.append(cut)
    return [piece.part(slice(lo, hi)) for lo, hi in itertools.pairwise([*edges, piece.theta_m.size])]


def _head_and_tail(run: Recording) -> Parts | None:
    """The end of it to test with, cut in the piece in which it begins: where rows are missing there are several."""
    wish = int(KEPT * sum(piece.theta_m.size for piece in run.pieces))
    before = np.cumsum([0, *(piece.theta_m.size for piece in run.pieces)])
    k = int(np.searchsorted(before, wish, side="right")) - 1
    piece = run.pieces[k]
    find = _cut_locked if run.locked else _cut
    cut = find(piece.theta_m, wish - int(before[k]))
    if cut is None:
        return None
    head, tail = piece.part(slice(0, cut)), piece.part(slice(cut, None))
    return (*run.pieces[:k], head), (tail, *run.pieces[k + 1 :])


def _both_ways(theta: Array, stroke: slice) -> int:
    """Where the part held out begins whose last stroke would be all of it, and so run one way only: in the stroke
    before, with a turn of the motor or more left of that; where it is shorter, after it."""
    cut = stroke.start + int(TURNED_BACK * (stroke.stop - stroke.start))
    return cut if float(abs(theta[stroke.stop - 1] - theta[cut])) >= TURN else int(stroke.stop)


def _cut_locked(theta: Array, wish: int) -> int | None:
    """That of `_cut`; of a motor that sticks, goes up a stair and trembles on its steps, the row nearest to `wish` at
    which the gear was wound up most either way: a spring is not foretold beyond the torques it was fitted at."""
    edges = np.array(wound_back(theta, WOUND * float(np.ptp(theta))))
    if not edges.size or len(strokes(theta)) <= STAIR * (edges.size + 1):
        return _cut(theta, wish)
    return int(edges[np.argmin(np.abs(edges - wish))])


def _cut(theta: Array, wish: int) -> int | None:
    """The row of an angle (n,) nearest to `wish` at which it turns back, or has gone whole turns."""
    parts = strokes(theta)
    if len(parts) >= 2:
        edges = np.array([p.stop for p in parts[:-1]])
        cut = int(edges[np.argmin(np.abs(edges - wish))])
        return _both_ways(theta, parts[-2]) if cut == edges[-1] and len(parts) > FORTH_AND_BACK else cut
    turn = int(2 * np.pi / max(1e-9, float(np.mean(np.abs(np.diff(theta))))))
    return turn * (wish // turn) if theta.size > 2 * turn and turn > 0 and wish >= turn else None
