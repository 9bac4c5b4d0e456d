"""What the samples of a run cannot tell: too few rows, no time, time that stands still, values that are no numbers.

No promise is broken by them, as the format allows a run without time and another logger may write what it likes; but
who asks whether a run is sound has to hear of them before an analysis does.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pyarrow as pa

from rig.runfile.finding import Finding
from rig.runfile.run import Run

FEW = 10  # rows, below which there is nothing to make a mean of


def values(run: Run) -> Iterator[Finding]:
    """Warnings and notes on the values themselves; every column is read once."""
    if run.rows < FEW:
        yield Finding("warning", "rows", f"too few rows for any figure: {run.rows}, expected {FEW} or more")
    if not run.rows:
        return
    yield from _time(run)
    for name, (nan, infinite) in _no_numbers(run).items():
        said = " and ".join(f"{n} {what}" for n, what in ((nan, "NaN"), (infinite, "infinite")) if n)
        if said:
            expected = "expected numbers, and null where nothing was measured"
            yield Finding("warning", "values", f"{name}: of {run.rows} values {said}; {expected}")


def _time(run: Run) -> Iterator[Finding]:
    t = run.column("t")
    if t is None:
        yield Finding("note", "time", "there is no t: gaps and speeds cannot be told, analysis works in angle")
        return
    still = int(np.count_nonzero(t[1:] == t[:-1]))
    if still:
        yield Finding("warning", "time", f"{still} of {run.rows} rows have the t of the row before them")


def _no_numbers(run: Run) -> dict[str, tuple[int, int]]:
    """How many values of each column are NaN (null is not) and how many are infinite."""
    found: dict[str, tuple[int, int]] = {}
    for batch in run.samples.batches():
        for field, column in zip(batch.schema, batch.columns, strict=True):
            if pa.types.is_floating(field.type):
                nan, infinite = found.get(field.name, (0, 0))
                there = column.drop_null().to_numpy(zero_copy_only=False)
                found[field.name] = (
                    nan + int(np.count_nonzero(np.isnan(there))),
                    infinite + int(np.count_nonzero(np.isinf(there))),
                )
    return found
