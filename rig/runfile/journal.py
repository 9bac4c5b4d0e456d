"""The journal: Arrow IPC streams appended while running, `journal-0001.arrows` and, after a restart, the next number.

Each batch carries the index of its first row in the run and a checksum, so a reader knows what is whole and what is
missing. What a kill tore off at the end is not read and not removed: nothing is ever cut from a raw file.
"""

from __future__ import annotations

import contextlib
import errno
import io
import os
from collections.abc import Iterator
from pathlib import Path

import pyarrow as pa

from rig.core.regular import regular
from rig.runfile.columns import checksum, no_rows
from rig.runfile.manifest import sync_folder
from rig.runfile.remains import journal_files

FIRST, CRC = b"first", b"crc32"  # keys of a batch's own metadata
GATHERED = 65_536  # bytes: 0.2 s at 2 kHz; of what is larger, columns go by themselves
END = b"\xff\xff\xff\xff\0\0\0\0"  # how an Arrow stream says that nothing follows


def _last_number(folder: Path) -> int:
    numbers = (path.stem.removeprefix("journal-") for path in journal_files(folder))
    return max((int(number) for number in numbers if number.isdecimal()), default=0)


class JournalWriter:
    """Appends batches to a new journal file. A batch is in it whole or not at all, unless the writer is killed."""

    def __init__(self, folder: Path, layout: pa.Schema, first: int) -> None:
        """`first` is the index in the run of the first row to come. Raises OSError."""
        self.path = folder / f"journal-{_last_number(folder) + 1:04d}.arrows"
        self.rows = first  # index of the next row
        self._layout = layout
        self._file = os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND, 0o644)
        self._end = 0  # bytes that are whole
        self._buffer = io.BytesIO()
        # Arrow writes a batch in some fifty pieces: gathered on its side, they are handed over as one
        self._pieces = pa.BufferedOutputStream(pa.PythonFile(self._buffer, "w"), GATHERED)
        self._stream = pa.ipc.new_stream(self._pieces, layout)
        try:
            self.append(no_rows(layout))  # the schema, and a full disk, come to light now
            self.sync()
            sync_folder(folder)
        except OSError:
            os.close(self._file)
            self.path.unlink(missing_ok=True)
            raise

    def append(self, columns: list[pa.Array]) -> None:
        """Hand one batch to the operating system. Raises OSError; then the file ends where it did before."""
        about = {FIRST: str(self.rows), CRC: str(checksum(columns, self.rows))}
        batch = pa.RecordBatch.from_arrays(columns, schema=self._layout)
        self._stream.write_batch(batch, custom_metadata=about)
        self._flush()
        self.rows += batch.num_rows

    def sync(self) -> None:
        """Wait until everything appended is on disk. Raises OSError, also when the file was removed or cut."""
        os.fdatasync(self._file)
        state = os.fstat(self._file)
        if not state.st_nlink or state.st_size < self._end:
            raise FileNotFoundError(errno.ENOENT, "somebody removed or cut it while it was written", str(self.path))

    def close(self) -> None:
        """Write the stream's end and make it safe. Raises OSError; the file is closed either way."""
        try:
            self._stream.close()
            self._flush()
            self.sync()
        finally:
            os.close(self._file)

    def _flush(self) -> None:
        self._pieces.flush()
        data = self._buffer.getvalue()
        self._buffer.seek(0)
        self._buffer.truncate()
        try:
            _write_all(self._file, data)
        except OSError:
            with contextlib.suppress(OSError):  # a full disk can always be given back what was just taken
                os.ftruncate(self._file, self._end)
            raise
        self._end += len(data)


def _write_all(handle: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(handle, view) :]


class JournalReader:
    """The rows of every journal of a run, in order, to the last whole batch. Iterate first, then look at the counts."""

    def __init__(self, folder: Path) -> None:
        self.files = journal_files(folder)
        self._reset()

    def _reset(self) -> None:
        self.next_row = 0  # index in the run of the row after the last
        self.torn_bytes = 0  # at the end of a file, after its last whole batch
        self.missing = 0  # rows that a later batch says came before it, and that are not there
        self.layout: pa.Schema | None = None

    def __iter__(self) -> Iterator[pa.RecordBatch]:
        self._reset()
        for path in self.files:
            yield from self._whole(path)

    def _whole(self, path: Path) -> Iterator[pa.RecordBatch]:
        """Batches of one file until it ends or is torn. Rows an earlier file already gave are left out."""
        good = 0  # bytes that are whole
        regular(path)
        with pa.OSFile(str(path)) as source:
            for batch, first in _batches(source):
                good = source.tell()
                self.layout = self.layout or batch.schema
                start = self.next_row if first is None else first
                self.missing += max(0, start - self.next_row)
                fresh = batch.slice(max(0, self.next_row - start))
                self.next_row = max(self.next_row, start + batch.num_rows)
                if fresh.num_rows:
                    yield fresh
        self.torn_bytes += _torn(path, good)


def _torn(path: Path, good: int) -> int:
    """Bytes after the first `good` ones, the stream's proper end aside."""
    rest = path.stat().st_size - good
    with open(path, "rb") as file:
        file.seek(good)
        return 0 if rest == len(END) and file.read() == END else rest


def _batches(source: pa.NativeFile) -> Iterator[tuple[pa.RecordBatch, int | None]]:
    """Whole batches of one stream, each with the index of its first row where it carries one."""
    try:
        stream = pa.ipc.open_stream(source)
        while True:
            batch, about = stream.read_next_batch_with_custom_metadata()
            if about is None or CRC not in about:
                yield batch, None
                continue
            first = int(about[FIRST])
            if int(about[CRC]) != checksum(batch.columns, first):
                return
            yield batch, first
    except (StopIteration, ValueError, OSError, pa.ArrowException):
        return  # the stream's end, or a tear


def rows_in_journal(folder: Path) -> int:
    """Index of the row that would follow the last whole one. Reads everything."""
    reader = JournalReader(folder)
    for _ in reader:
        pass
    return reader.next_row


def rows_missing(folder: Path) -> int:
    """Rows that a later batch says came before it, and that are not there. Reads everything."""
    reader = JournalReader(folder)
    for _ in reader:
        pass
    return reader.missing
