"""CSV: a row of names, a row of units, then the samples. What was not measured is empty.

A simulated run has a last column named SIMULATED, so that nobody who opens the file can overlook it.
"""

from __future__ import annotations

import csv
from pathlib import Path

import pyarrow as pa
import pyarrow.csv as arrow_csv

from rig.runfile.manifest import SIMULATED
from rig.runfile.run import Run


def write(run: Run, path: Path) -> None:
    """Write every column of `run`, numbers to the last digit. Raises OSError."""
    names = list(run.channels)
    units = [run.unit(name) for name in names]
    if run.simulated:
        names, units = [*names, SIMULATED], [*units, "every value of this file"]
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows((names, units))
    with open(path, "ab") as file:
        for batch in run.samples.batches():
            arrow_csv.write_csv(_marked(batch, run.simulated), file, _PLAIN)


_PLAIN = arrow_csv.WriteOptions(include_header=False)


def _marked(batch: pa.RecordBatch, simulated: bool) -> pa.Table:
    table = pa.Table.from_batches([batch])
    return table.append_column(SIMULATED, pa.nulls(batch.num_rows, pa.int8())) if simulated else table
