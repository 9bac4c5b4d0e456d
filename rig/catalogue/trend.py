"""One figure over days and assemblies, with a mark where it changed by more than its repeats scatter."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rig.catalogue.figures import Figure, bare, common_label, figures, names_of, refuse_unknown
from rig.catalogue.filter import Filter
from rig.catalogue.repeats import figure_of
from rig.catalogue.row import UNREADABLE, Row, finite
from rig.catalogue.sameness import Mounting, Point, mounting, point, words
from rig.catalogue.scan import quickly_doubted, runs
from rig.catalogue.scan import row as row_in
from rig.catalogue.scatter import SHARE, Scatter, scatter
from rig.core.errors import UsageError
from rig.runfile.copies import known_by, measured_once


@dataclass(frozen=True)
class Spot:
    """One run in a trend."""

    row: Row
    figure: Figure
    assembly: int  # 1, 2, … in order of time; the same number: nobody took the rig apart between the runs
    level: float  # mean of the runs before it since the last change; NaN for the first
    limit: float  # how far from that level a run of an unchanged gear stays, 99 times of 100; NaN when not known
    changed: bool


@dataclass(frozen=True)
class Series:
    """Runs of one gear, procedure and operating point, in order of time."""

    gear: str
    procedure: str
    simulated: bool
    title: str
    label: str  # of the figure
    unit: str
    spots: tuple[Spot, ...]
    scatter: Scatter

    @property
    def sentence(self) -> str:
        """What was seen, and by which measure."""
        marked = [s for s in self.spots if s.changed]
        if not self.scatter.known:
            return f"changes cannot be judged, {self.scatter.words(self.unit)}"
        seen = "no change larger than reproducibility"
        if marked:
            when = ", ".join(
                f"{_when(s.row)} by {_signed(s.figure.value - s.level)} {self.unit}".removesuffix(" 1") for s in marked
            )
            seen = f"{len(marked)} change{'s' if len(marked) > 1 else ''} larger than reproducibility: {when}"
        return f"{seen}; {self.scatter.words(self.unit)}"


def _when(row: Row) -> str:
    return row.started_utc[:10] or row.path.name


def _signed(value: float) -> str:
    return f"{value:+.3g}".replace("-", "−")


@dataclass(frozen=True)
class Trend:
    """One figure of a catalogue of runs."""

    figure: str
    series: tuple[Series, ...]
    left_out: int  # runs that have the figure and do not count: not completed, or rejected
    copies: tuple[str, ...] = ()  # folders left out: unreadable, their run is there already, or in doubt; in sentences

    def as_json(self) -> dict[str, Any]:
        """Schema hdrig.trend/1; numbers that are not finite as null."""
        return {
            "schema": "hdrig.trend/1",
            "figure": self.figure,
            "left_out": self.left_out,
            "copies": list(self.copies),
            "marked_at": SHARE,
            "series": [
                {
                    "gear": s.gear,
                    "procedure": s.procedure,
                    "simulated": s.simulated,
                    "title": s.title,
                    "label": s.label,
                    "unit": s.unit,
                    "scatter": {"sd": finite(s.scatter.sd), "dof": s.scatter.dof, "repeats": s.scatter.repeats,
                                "assemblies": s.scatter.sets, "how": s.scatter.words(s.unit)},
                    "sentence": s.sentence,
                    "points": [_spot(p) for p in s.spots],
                }
                for s in self.series
            ],
        }  # fmt: skip


def trend(root: Path | str, figure: str, gear: str = "") -> Trend:
    """`figure` (peak-to-peak, C_2, K1, hysteresis-loss, friction, or the name of an estimate) of every run under `root`
    that was completed; `gear` is a serial, * and ? stand for anything.

    Raises UsageError without such a folder, without a run in it, or when none of its runs has the figure.
    """
    copies: dict[Path, str] = {}
    again: dict[Path, str] = {}
    found = runs(root, Filter(gear=gear), lambda folder, why: copies.update({folder: why}))
    unreadable = [f"{row.path.name} is left out: {row.problem}" for row in found if row.status == UNREADABLE]
    readable = [row for row in found if row.status != UNREADABLE]
    found = list(measured_once(readable, lambda folder, why: again.update({folder: why})))
    kept: dict[tuple[Point, str], list[tuple[Row, Figure]]] = defaultdict(list)
    counted: list[Row] = []
    doubts: list[str] = []
    for there in found:
        row = there if figure_of(there, names_of(figure)) is None else _sound(there, copies, doubts)
        if row is not None and (one := figure_of(row, names_of(figure))) is not None:
            kept[point(row), one.name].append((row, one))
            counted.append(row)
    if not found:
        of = f" of a gear '{gear}'" if gear else ""
        raise UsageError(
            "; ".join([f"there are no runs in {root}{of}{' that can be read' * bool(unreadable)}", *unreadable])
        )
    if not kept:
        refuse_unknown(figure, _seen(found), bare(root, [row.path for row in found if not _names(row)], len(found)))
    numbers = _numbers(counted)
    series = tuple(_series(at, members, numbers) for (at, _), members in kept.items())
    copies |= {path: why for path, why in again.items() if figure_of(row_in(path), names_of(figure)) is not None}
    told = (*unreadable, *doubts, *(f"{folder.name} is left out: {why}" for folder, why in copies.items()))
    return Trend(figure, series, _left_out(found, figure) - len(counted) - len(doubts), told)


def _sound(there: Row, copies: dict[Path, str], doubts: list[str]) -> Row | None:
    """The run, or where its figures are in doubt a copy of it whose are not, which then is no copy that is left out;
    None where there is none, which is added to the `doubts`."""
    doubt = quickly_doubted(there).doubt
    if not doubt:
        return there
    for folder in copies:
        copy = row_in(folder)
        if known_by(copy) == known_by(there) and not quickly_doubted(copy).doubt:
            copies.pop(folder)
            copies[there.path] = f"its figures are in doubt, those of its copy {folder} are not: {doubt}"
            return copy
    doubts.append(f"{there.path.name} is left out: its figures are in doubt: {doubt}")
    return None


def _seen(found: Sequence[Row]) -> set[str]:
    return {name for row in found for name in _names(row)}


def _left_out(found: Sequence[Row], figure: str) -> int:
    wanted = set(names_of(figure))
    return sum(1 for row in found if wanted & _names(row))


def _names(row: Row) -> set[str]:

    try:
        return set(figures(row.path))
    except UsageError:
        return set()


def _numbers(rows: Sequence[Row]) -> dict[tuple[str, Mounting], int]:
    """1, 2, … for each gear in order of time: an assembly has one number in every series."""
    of_gear: dict[str, dict[Mounting, None]] = defaultdict(dict)
    for row in sorted(rows, key=lambda row: row.started_utc):
        of_gear[row.gear].setdefault(mounting(row))
    return {(gear, one): k for gear, found in of_gear.items() for k, one in enumerate(found, 1)}


def _series(at: Point, members: Sequence[tuple[Row, Figure]], numbers: Mapping[tuple[str, Mounting], int]) -> Series:
    sets: dict[Mounting, list[float]] = defaultdict(list)
    for row, figure in members:
        sets[mounting(row)].append(figure.value)
    spread = scatter(sets.values())
    spots, since = [], [members[0]]
    for k, (row, figure) in enumerate(members):
        spot = _judged(row, figure, numbers[at.gear, mounting(row)], [f for _, f in since], spread) if k else Spot(
            row, figure, numbers[at.gear, mounting(row)], math.nan, math.nan, False
        )  # fmt: skip
        spots.append(spot)
        since = [(row, figure)] if spot.changed else [*since, (row, figure)] if k else since
    last = members[-1][1]
    title = f"{at.gear or 'gear without serial number'}, {words(at)}"
    label = common_label(figure for _, figure in members)
    return Series(at.gear, at.procedure, at.simulated, title, label, last.unit, tuple(spots), spread)


def _judged(row: Row, figure: Figure, assembly: int, before: Sequence[Figure], spread: Scatter) -> Spot:
    """Against the mean of the runs since the last change, so that a slow drift is seen too, once it is large enough."""
    n = len(before)
    level, limit = sum(f.value for f in before) / n, spread.limit(1, n)
    off = abs(figure.value - level)
    halves = [f.half if math.isfinite(f.half) else 0.0 for f in before]
    own = math.hypot(figure.half if math.isfinite(figure.half) else 0.0, math.sqrt(sum(h * h for h in halves)) / n)
    return Spot(row, figure, assembly, level, limit, off > limit and off > own)


def _spot(s: Spot) -> dict[str, Any]:
    return {
        "path": str(s.row.path),
        "uid": s.row.uid or None,
        "started_utc": s.row.started_utc or None,
        "assembly": s.assembly,
        "value": finite(s.figure.value),
        "ci95": [finite(s.figure.low), finite(s.figure.high)],
        "level": finite(s.level),
        "reproducibility": finite(s.limit),
        "changed": s.changed,
    }
