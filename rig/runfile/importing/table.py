"""What a reader hands over, and how a column is found in a foreign file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rig.core.errors import UsageError
from rig.runfile.importing.mapping import Dialect
from rig.runfile.importing.strict import nearest

Array = npt.NDArray[Any]


class Table(NamedTuple):
    """The columns asked for, each 1-D: whole numbers, floats (null = NaN), dates, or what else the file holds."""

    columns: dict[str, Array]
    units: dict[str, str]  # as the file states them
    started: datetime | None = None  # when t = 0 was, where the file states it
    notes: tuple[str, ...] = ()  # what the reader noticed and let pass
    simulated: bool = False  # the file says so: it is the export of a run on the twin
    text: bool = False  # the file is text, which [csv] says how to read


Reader = Callable[[Path, Sequence[str], Dialect], Table]
"""(file, columns wanted, [csv]) → those columns. Raises UsageError, and for a damaged file what its library raises."""


def locate(names: Iterable[str], wanted: Sequence[str], file: str) -> dict[str, str]:
    """{column asked for: its full name in the file}. The last part of a path is enough where it is unique.

    Raises UsageError naming the column and the nearest there is, or the paths it could mean.
    """
    places: dict[str, list[str]] = {}
    for name in names:
        places.setdefault(name, []).append(name)
        last = name.rpartition("/")[2]
        if last != name:
            places.setdefault(last, []).append(name)
    found = {}
    for column in wanted:
        paths = places.get(column, [])
        if not paths:
            raise UsageError(f"{file} has no column '{column}'; {nearest(column, places)}")
        if len(paths) > 1:
            different = f"one of {', '.join(paths)}" if len(set(paths)) > 1 else "it once"
            raise UsageError(f"{file}: column '{column}' stands in {len(paths)} places; expected {different}")
        found[column] = paths[0]
    return found


def flat(values: Any) -> Array | None:
    """A vector from something that is one (n, n×1 or 1×n), else None."""
    array = np.asarray(values)
    if array.ndim == 0 or array.size != max(array.shape):
        return None
    return array.reshape(-1)
