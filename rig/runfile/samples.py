"""Where a run's samples are kept, and how one channel is read without the others."""

from __future__ import annotations

import contextlib
import os
from abc import ABC, abstractmethod
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from rig.core.channels import CHANNEL
from rig.core.errors import SHUT, DataError, UsageError, of_place
from rig.core.regular import regular
from rig.core.rows import room
from rig.runfile.archive import NAME
from rig.runfile.columns import Array, as_float
from rig.runfile.importing.units import known
from rig.runfile.journal import JournalReader
from rig.runfile.remains import journal_files

BATCH = 65_536  # rows at a time, where somebody reads them all


class Samples(ABC):
    """The samples of one run."""

    path: Path
    layout: pa.Schema
    rows: int

    @abstractmethod
    def column(self, name: str) -> Array:
        """One channel as float64, shape (rows,), null as NaN. Raises DataError when it is damaged or not numbers."""

    @abstractmethod
    def empty(self, name: str) -> bool:
        """True when the channel was never measured: every value null."""

    @abstractmethod
    def batches(self) -> Iterator[pa.RecordBatch]:
        """All channels, some rows at a time, in order."""


class Archive(Samples):
    """`samples.parquet`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with _read(path):
            regular(path)
            file = pq.ParquetFile(path)
            self.layout = file.schema_arrow
        self._about = file.metadata
        self.rows = self._about.num_rows

    def column(self, name: str) -> Array:
        out, row = room(self.rows), 0
        with _read(self.path):
            # one column keeps one thread busy: to hand it to Arrow's others would cost as much as reading it
            for batch in self._open().iter_batches(batch_size=BATCH, columns=[name], use_threads=False):
                out[row : row + batch.num_rows] = as_float(pa.chunked_array(batch.columns))
                row += batch.num_rows
        return out

    def empty(self, name: str) -> bool:
        groups = [self._about.row_group(i) for i in range(self._about.num_row_groups)]
        known = [g.column(self.layout.get_field_index(name)).statistics for g in groups]
        if any(k is not None and k.has_min_max for k in known):  # there is a least value: one was measured
            return False
        return bool(np.isnan(self.column(name)).all())  # null, NaN, or written without statistics

    def batches(self) -> Iterator[pa.RecordBatch]:
        with _read(self.path):
            yield from self._open().iter_batches(batch_size=BATCH)

    def row_groups(self) -> Iterator[pa.Table]:
        """The file's own groups: 60 s each where we wrote it."""
        with _read(self.path):
            file = self._open()
            for i in range(self._about.num_row_groups):
                yield file.read_row_group(i)

    def _open(self) -> pq.ParquetFile:
        # the footer is read once, no file is held open; what was read is let go, not kept to the end of the file
        return pq.ParquetFile(self.path, metadata=self._about, pre_buffer=False)


class Journal(Samples):
    """The journal of a run that was never closed: every whole batch, read at once."""

    def __init__(self, folder: Path) -> None:
        self.path = journal_files(folder)[0]
        reader = JournalReader(folder)
        with _read(self.path):
            batches = list(reader)
        if reader.layout is None:
            raise DataError(f"{self.path} holds no whole batch of samples")
        self._table = pa.Table.from_batches(batches, reader.layout)
        self.layout, self.rows = reader.layout, self._table.num_rows

    def column(self, name: str) -> Array:
        with _read(self.path):
            return as_float(self._table.column(name))

    def empty(self, name: str) -> bool:
        return bool(self._table.column(name).null_count == self.rows)

    def batches(self) -> Iterator[pa.RecordBatch]:
        yield from self._table.to_batches(max_chunksize=BATCH)


def open_samples(folder: Path) -> Samples:
    """The archive where there is one, else the journal. Raises DataError when there is neither, UsageError for other
    units."""
    if (folder / NAME).exists():
        found: Samples = Archive(folder / NAME)
    elif journal_files(folder):
        found = Journal(folder)
    else:
        raise DataError(f"{folder} has no samples: neither {NAME} nor a journal")
    names = found.layout.names
    for name in names:
        if names.count(name) > 1:
            raise UsageError(f"{found.path} has {names.count(name)} columns named {name}, expected one")
    for field in found.layout:
        _refuse_other_units(found.path, field)
    return found


def _refuse_other_units(path: Path, field: pa.Field) -> None:
    """Raises UsageError when a column of the table says it is in another unit than the table's, or is not numbers."""
    channel = CHANNEL.get(field.name)
    if channel is None:
        return
    said = (field.metadata or {}).get(b"unit", b"").decode(errors="replace")
    unit = known(said)
    if channel.unit and said and (unit is None or unit.word != channel.unit):
        raise UsageError(f"{path}: column {field.name} is in {said!r}, expected {channel.unit!r}; convert it on import")
    if not (pa.types.is_floating(field.type) or pa.types.is_integer(field.type)):
        raise UsageError(f"{path}: column {field.name} holds {field.type}, expected numbers")


@contextlib.contextmanager
def _read(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        if error.errno is None:  # the library's, of what it found
            raise _damaged(path) from error
        said = os.strerror(error.errno) if error.errno in SHUT else error.strerror
        raise of_place(DataError(f"{path} cannot be read: {said}"), error) from error
    except pa.ArrowException as error:
        raise _damaged(path) from error


def _damaged(path: Path) -> DataError:
    """What a library says of damage names its own inside; that a file was cut short shows in its size."""
    return DataError(f"{path} cannot be read: it is damaged or cut short ({path.stat().st_size} bytes)")
