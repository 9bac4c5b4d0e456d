"""HDF5: one dataset a channel, `unit` and `meaning` as its attributes; the manifest beside them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pyarrow as pa

from rig.core.ring import NO_COUNTS
from rig.runfile.columns import Array
from rig.runfile.run import Run

CHUNK = 16_384  # rows


def write(run: Run, path: Path) -> None:
    """Write every column of `run`; not measured is NaN, or the dataset's `_FillValue` where it holds integers."""
    with h5py.File(path, "x") as file:
        file.attrs["schema"] = run.manifest["schema"]
        file.attrs["procedure"] = run.procedure
        file.attrs["simulated"] = run.simulated
        file.create_dataset("manifest", data=json.dumps(run.manifest, ensure_ascii=False))
        sets = {name: _dataset(file, run, name) for name in run.channels}
        row = 0
        for batch in run.samples.batches():
            for name, into in sets.items():
                into[row : row + batch.num_rows] = _values(batch.column(name))
            row += batch.num_rows


def _dataset(file: h5py.File, run: Run, name: str) -> Any:
    kind = _dtype(run.samples.layout.field(name).type)
    how = {"chunks": (min(CHUNK, run.rows),), "compression": "gzip", "shuffle": True} if run.rows else {}
    made = file.create_dataset(name, shape=(run.rows,), dtype=kind, **how)
    made.attrs["unit"], made.attrs["meaning"] = run.unit(name), run.meaning(name)
    if kind == np.int64:
        made.attrs["_FillValue"] = NO_COUNTS
    return made


def _dtype(kind: pa.DataType) -> Any:
    return np.dtype(kind.to_pandas_dtype())


def _values(column: pa.Array) -> Array:
    if pa.types.is_integer(column.type):
        column = column.fill_null(NO_COUNTS if column.type == pa.int64() else 0)
    return np.asarray(column.to_numpy(zero_copy_only=False))
