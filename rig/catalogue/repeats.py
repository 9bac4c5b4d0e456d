"""The repeats of a run in a catalogue, and how far one figure of theirs scatters."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable

from rig.catalogue.figures import Figure, figures
from rig.catalogue.row import Row
from rig.catalogue.sameness import Mounting, Point, mounting, point
from rig.catalogue.scatter import Scatter, scatter
from rig.core.errors import UsageError
from rig.runfile.copies import known_by

COUNTS = ("completed", "imported", "")  # statuses of runs whose figures count; a folder made elsewhere may say nothing


def figure_of(row: Row, names: Iterable[str]) -> Figure | None:
    """The first of `names` that `row` has and that counts; None where there is none, or its file is damaged."""
    if row.status not in COUNTS:
        return None
    try:
        found = figures(row.path)
    except UsageError:
        return None
    one = next((found[name] for name in names if name in found), None)
    return one if one is not None and math.isfinite(one.value) and not one.rejected else None


class Repeats:
    """Runs by what they measure and in which assembly, each list in order of time."""

    def __init__(self, rows: Iterable[Row]) -> None:
        self._sets: dict[Point, dict[Mounting, list[Row]]] = defaultdict(lambda: defaultdict(list))
        for row in sorted(rows, key=lambda row: row.started_utc):
            self._sets[point(row)][mounting(row)].append(row)

    def scatter(self, at: Point, name: str, without: Iterable[Row] = ()) -> Scatter:
        """Of the figure `name` at one point. `without` are runs that may not speak for themselves."""
        left_out = {known_by(row) for row in without}
        rows = [[r for r in one if known_by(r) not in left_out] for one in self._sets.get(at, {}).values()]
        return scatter([[f.value for r in one if (f := figure_of(r, (name,))) is not None] for one in rows])
