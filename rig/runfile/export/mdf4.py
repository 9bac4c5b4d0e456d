"""ASAM MDF 4: one channel group on the time of the samples, units and meanings with each channel."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from asammdf import MDF, Signal

from rig.core.errors import UsageError
from rig.runfile.columns import Array
from rig.runfile.manifest import SIMULATED
from rig.runfile.run import Run

VERSION = "4.10"  # what CANape, DIAdem and MDA of the last ten years read
COMPRESSION = 2  # transposed deflate: a quarter of the size

MASTER = ("t", 1)  # name of the time channel as in every other export (asammdf would say `time`); 1: it is a time

Column = tuple[Array, Array]  # values, and where they are invalid


def write(run: Run, path: Path) -> None:
    """Write every measured channel of `run`; what was not measured is marked invalid. Raises UsageError without `t`."""
    if not run.has("t"):
        raise UsageError(f"{run.name} has no t: an MDF group needs its time; csv and hdf5 do not")
    names = [name for name in run.channels if name != "t" and run.has(name)]
    with MDF(version=VERSION) as mdf:
        _head(mdf, run)
        for number, (t, columns) in enumerate(_blocks(run, names)):
            if number == 0:
                signals = [_signal(run, name, t, column) for name, column in zip(names, columns, strict=True)]
                mdf.append(signals, acq_name=SIMULATED if run.simulated else "rig", common_timebase=True)
            else:
                mdf.extend(0, [(t, None), *columns])
        mdf.save(path, compression=COMPRESSION)


def _head(mdf: Any, run: Run) -> None:
    mdf.header.author = str(run.manifest.get("operator") or "")
    mdf.header.project = f"hdrig {run.procedure}"
    mdf.header.subject = str((run.manifest.get("gear") or {}).get("serial") or "")
    mdf.header.description = f"{'SIMULATED: every value is from the twin. ' if run.simulated else ''}Run {run.name}"
    if run.started:
        mdf.header.start_time = run.started


def _signal(run: Run, name: str, t: Array, column: Column) -> Any:
    values, invalid = column
    said = {"comment": run.meaning(name), "master_metadata": MASTER}
    return Signal(values, t, run.unit(name), name, invalidation_bits=invalid, **said)


def _blocks(run: Run, names: list[str]) -> Iterator[tuple[Array, list[Column]]]:
    """Time [s] and channels, some rows at a time; samples without time are left out."""
    for batch in run.samples.batches():
        timed = batch.filter(batch.column("t").is_valid())
        yield timed.column("t").to_numpy(), [_column(timed.column(name)) for name in names]


def _column(column: pa.Array) -> Column:
    invalid = np.asarray(column.is_null().to_numpy(zero_copy_only=False))
    return np.asarray(column.fill_null(0).to_numpy(zero_copy_only=False)), invalid
