"""Journal → `samples.parquet`. The same samples give the same bytes, whatever the batches were that brought them."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from rig.runfile.columns import as_float
from rig.runfile.manifest import sync_folder
from rig.runfile.remains import SAMPLES

NAME = SAMPLES
GROUP = 60.0  # s in a row group: one channel of ten hours is 600 small reads, and memory stays flat
GROUP_ROWS = 1 << 20  # at most: 60 s at 17 kHz, or a time that stands still


class Extent(NamedTuple):
    """How much a run holds."""

    rows: int
    seconds: float  # from the first sample to the last


def row_groups(batches: Iterable[pa.RecordBatch]) -> Iterator[pa.Table]:
    """The same rows in tables of one chunk, cut where `t` passes a multiple of 60 s: by the samples alone."""
    held: list[pa.RecordBatch] = []
    minute, rows = None, 0
    for batch in batches:
        for piece, number in _pieces(batch):
            while piece.num_rows:
                if held and (number != minute or rows == GROUP_ROWS):
                    yield _joined(held)
                    held, rows = [], 0
                part = piece.slice(0, GROUP_ROWS - rows)
                piece = piece.slice(part.num_rows)
                held.append(part)
                minute, rows = number, rows + part.num_rows
    if held:
        yield _joined(held)


def _joined(batches: list[pa.RecordBatch]) -> pa.Table:
    """One chunk a column: where chunks end would show in the pages of the file."""
    return pa.Table.from_batches(batches).combine_chunks()


def _pieces(batch: pa.RecordBatch) -> Iterator[tuple[pa.RecordBatch, float]]:
    """Stretches of a batch that lie in one minute of `t`; a sample without time counts as minute -1."""
    if not batch.num_rows:
        return
    minutes = np.nan_to_num(np.floor(as_float(pa.chunked_array([batch.column("t")])) / GROUP), nan=-1.0)
    cuts = [0, *(np.flatnonzero(np.diff(minutes)) + 1).tolist(), batch.num_rows]
    for start, stop in itertools.pairwise(cuts):
        yield batch.slice(start, stop - start), float(minutes[start])


def write_archive(folder: Path, tables: Iterable[pa.Table], layout: pa.Schema) -> Extent:
    """Write `samples.parquet` from tables of one row group each; it is there whole or not at all. Raises OSError."""
    part = folder / f".{NAME}.part"
    rows, first, last = 0, None, None
    with open(part, "wb") as file:
        with open_parquet(file, layout) as writer:
            for table in tables:
                writer.write_table(table, row_group_size=GROUP_ROWS)
                t = table.column("t").drop_null()
                rows += table.num_rows
                first = t[0].as_py() if first is None and len(t) else first
                last = t[-1].as_py() if len(t) else last
        file.flush()
        os.fsync(file.fileno())
    part.replace(folder / NAME)
    sync_folder(folder)
    return Extent(rows, (last or 0.0) - (first or 0.0))


def open_parquet(file: object, layout: pa.Schema) -> pq.ParquetWriter:
    """A writer of archives: zstd, the bytes of floats split by significance, counts as differences."""
    encoding = {field.name: _encoding(field.type) for field in layout}
    return pq.ParquetWriter(
        file, layout, compression="zstd", compression_level=3, use_dictionary=False, column_encoding=encoding
    )


def _encoding(kind: pa.DataType) -> str:
    return "BYTE_STREAM_SPLIT" if pa.types.is_floating(kind) else "DELTA_BINARY_PACKED"
