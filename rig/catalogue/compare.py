"""Runs side by side: every figure with its interval, its difference to the first run, and whether that is a change."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

from rig.catalogue.figures import Figure, common_label, figures
from rig.catalogue.lacking import lacks, refuse_nothing, shared, without_figures
from rig.catalogue.repeats import COUNTS, Repeats
from rig.catalogue.row import UNREADABLE, Row, finite
from rig.catalogue.sameness import beside, mounting, point
from rig.catalogue.scan import doubted, row, rows
from rig.catalogue.scatter import SHARE, Scatter, between
from rig.core.errors import UsageError
from rig.runfile.copies import once

DOUBTED = "its figures are not to be believed: {}"
ROUNDING = 1e-9  # of a figure: what two computations of the same may differ by
DATE = "2026-11-20"  # how folders by date are named


class Mark(StrEnum):
    """What a difference amounts to."""

    CHANGED = "changed"  # larger than reproducibility, and its interval excludes zero
    WITHIN = "within"
    UNKNOWN = "unknown"  # no repeats to judge by
    NONE = ""  # nothing to compare, or not to be compared


@dataclass(frozen=True)
class Difference:
    """A later run's figure less the first run's."""

    value: float
    low: float  # of the 95 % interval, from the intervals of both runs [gum]; NaN where one has none
    high: float
    limit: float  # reproducibility: what two unchanged runs differ by at most, 99 times of 100; NaN when not known
    mark: Mark
    how: str  # how reproducibility was estimated


@dataclass(frozen=True)
class Line:
    """One figure of two runs or more; None where a run has none."""

    name: str
    label: str
    unit: str
    values: tuple[Figure | None, ...]
    differences: tuple[Difference | None, ...]  # one per run; None for the first


@dataclass(frozen=True)
class Comparison:
    """Runs side by side, the first of them the one the others are compared with."""

    rows: tuple[Row, ...]
    lines: tuple[Line, ...]
    remarks: tuple[str, ...]  # what stands in the way of a fair comparison, one sentence each

    def as_json(self) -> dict[str, Any]:
        """Schema hdrig.comparison/1; numbers that are not finite as null."""
        return {
            "schema": "hdrig.comparison/1",
            "runs": [row.as_json() for row in self.rows],
            "remarks": list(self.remarks),
            "marked_at": SHARE,
            "figures": [
                {
                    "name": line.name,
                    "label": line.label,
                    "unit": line.unit,
                    "values": [_figure(f) for f in line.values],
                    "differences": [_difference(d) for d in line.differences],
                }
                for line in self.lines
            ],
        }


def compare(paths: Sequence[Path], root: Path | None = None) -> Comparison:
    """Compare the runs in `paths` with the first of them. Repeats are looked for under `root`, or in the folders the
    runs lie in, and nowhere beyond.

    A figure that one run alone has is no line; the remarks say who lacks it. A run given twice counts once. Raises
    UsageError for fewer than two runs, a path that is none, a result that is damaged, or when no other run has any
    figure of the first.
    """
    given = [_run(path) for path in paths]
    if len(given) < 2:
        raise UsageError(
            f"compare was given {len(paths) or 'no'} run folder: expected two or more, the others against the first"
        )
    copies: list[str] = []
    found = tuple(once(given, lambda f, why: copies.append(f"{f.name} counts once: {why}")))
    if len(found) < 2:
        raise UsageError(f"compare was given one run {len(paths)} times: {'; '.join(copies)[:300]}")
    known = [figures(one.path) for one in found]
    refuse_nothing(found, known)
    homes = dict.fromkeys(map(_home, paths)) if root is None else [root]
    repeats = Repeats(once([one for home in homes for one in rows(str(home))]))
    lines = tuple(_line(name, found, known, repeats) for name in shared(known))
    return Comparison(found, lines, (*copies, *_remarks(found, known)))


def _run(path: Path) -> Row:
    if not path.is_dir():
        raise UsageError(f"{path} is no run folder")
    found = row(path)
    if found.status == UNREADABLE:
        raise UsageError(found.problem)
    return doubted(found)


def _home(path: Path) -> Path:
    """The folder that holds a run, its repeats beside it: of folders by date the one above."""
    parent = path.resolve().parent
    return parent.parent if len(parent.name) == len(DATE) and parent.name.replace("-", "").isdigit() else parent


def _line(name: str, found: Sequence[Row], known: Sequence[Mapping[str, Figure]], repeats: Repeats) -> Line:
    values = tuple(one.get(name) for one in known)
    shown = next(v for v in values if v is not None)
    differences = [_between(name, found[0], values[0], r, v, repeats) for r, v in zip(found, values, strict=True)]
    return Line(name, common_label(v for v in values if v is not None), shown.unit, values, (None, *differences[1:]))


def _between(name: str, a: Row, x: Figure | None, b: Row, y: Figure | None, repeats: Repeats) -> Difference | None:
    """b less a; None where either has no number, they have different units, or one does not count."""
    if x is None or y is None or x.unit != y.unit or x.rejected or y.rejected or not math.isfinite(x.value + y.value):
        return None
    value = y.value - x.value
    if abs(value) <= ROUNDING * max(abs(x.value), abs(y.value)):
        value = 0.0
    # each end from the two ends of the runs that face it: intervals need not be even
    low = value - math.hypot(y.value - y.low, x.high - x.value)
    high = value + math.hypot(y.high - y.value, x.value - x.low)
    of_a, of_b = _scatters(name, a, b, repeats)
    limit = of_a.limit() if point(a) == point(b) else between(of_a, of_b)
    mark = Mark.NONE if _counted(x) and _counted(y) else _mark(value, low, high, limit)
    return Difference(value, low, high, limit, mark, _how(a, b, of_a, of_b, x.unit))


def _counted(f: Figure) -> bool:
    """Revolutions, terms: they say what was done, and no gear changes by them."""
    return f.low == f.value == f.high


def _scatters(name: str, a: Row, b: Row, repeats: Repeats) -> tuple[Scatter, Scatter]:
    """Of both kinds of run. Two runs that are repeats of each other do not judge themselves."""
    same = point(a) == point(b) and mounting(a) == mounting(b)
    without = (a, b) if same else ()
    of_a = repeats.scatter(point(a), name, without)
    return of_a, of_a if point(a) == point(b) else repeats.scatter(point(b), name)


def _mark(value: float, low: float, high: float, limit: float) -> Mark:
    if math.isnan(limit):
        return Mark.UNKNOWN
    if low <= 0.0 <= high:  # false for NaN: without an interval the limit alone decides
        return Mark.WITHIN
    return Mark.CHANGED if abs(value) > limit else Mark.WITHIN


def _how(a: Row, b: Row, of_a: Scatter, of_b: Scatter, unit: str) -> str:
    if point(a) == point(b):
        return of_a.words(unit)
    return f"first run: {of_a.words(unit)}; other run: {of_b.words(unit)}"


def _remarks(found: Sequence[Row], known: Sequence[Mapping[str, Figure]]) -> list[str]:
    first, said = found[0], []
    for other in found[1:]:
        if other.gear != first.gear:
            gears = [f"gear {row.gear}" if row.gear else "a gear that nobody named" for row in (other, first)]
            said.append(f"{other.path.name} is of {gears[0]}, {first.path.name} of {gears[1]}")
        if other.simulated != first.simulated:
            said.append(f"one of {first.path.name} and {other.path.name} is simulated, the other is not")
        if point(other)[1:] != point(first)[1:]:
            said.append(
                f"{other.path.name} was not taken at the conditions of {first.path.name}: {_unlike(first, other)}"
            )
    for one, names in zip(found, known, strict=True):
        if one.status not in COUNTS:
            said.append(f"{one.path.name} is {one.status}: its figures are from what was recorded")
        said += [f"{one.path.name}: {why}" for why in (one.problem, one.doubt and DOUBTED.format(one.doubt)) if why]
        if why := without_figures(one, names):
            said.append(why)
    if not any(row.gear for row in found):
        said.append("no run names its gear (gear.serial): whether they are of one gear nobody can tell")
    return [*said, *lacks(found, known)]


def _unlike(a: Row, b: Row) -> str:
    """Procedure and conditions that differ, as "speed 9.6 rpm and 300 rpm"."""
    pairs = {"procedure": (a.procedure, b.procedure)}
    at_a, at_b = (json.loads(point(row).conditions) for row in (a, b))
    for key in dict.fromkeys([*a.conditions, *b.conditions, *at_a, *at_b]):
        if key in at_a or key in at_b:
            pairs[key] = (at_a.get(key, "not said"), at_b.get(key, "not said"))
    return ", ".join(beside(key, x, y) for key, (x, y) in pairs.items() if x != y) or "their kind"


def _figure(f: Figure | None) -> dict[str, Any] | None:
    if f is None:
        return None
    return {"value": finite(f.value), "ci95": [finite(f.low), finite(f.high)], "rejected": f.rejected}


def _difference(d: Difference | None) -> dict[str, Any] | None:
    if d is None:
        return None
    return {
        "value": finite(d.value),
        "ci95": [finite(d.low), finite(d.high)],
        "reproducibility": finite(d.limit),
        "mark": str(d.mark) or None,
        "how": d.how,
    }
