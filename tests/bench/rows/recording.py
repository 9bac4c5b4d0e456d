"""Row 10: keeping the rows."""

from __future__ import annotations

import os
import struct
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import ClassVar, final

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from rig.core.channels import CHANNELS
from rig.core.ring import Ring
from rig.core.sample import Sample
from rig.procedures.kinematic_error import KinematicError
from rig.runfile.archive import NAME, write_archive
from rig.runfile.columns import Array, columns_of_rows, schema
from rig.runfile.export import export
from rig.runfile.journal import JournalReader, JournalWriter
from rig.runfile.run import Run
from tests.bench.figure import AtMost, Figure, Shown, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds, cpu, take_turns
from tests.bench.twin import run

BATCH = 200  # rows handed on at a time: 0.2 s at 1 kHz, as the recorder does
SYNC = 4  # batches between two syncs to disk, as the recorder does
PUTS = 20_000  # rows handed over in one go, fewer than the ring holds
ROW = struct.Struct("10d3q")


def rows_of(folder: Path) -> Array:
    """The rows of a run as they lie in the ring, shape (n,), a field per channel."""
    found = Run.open(folder)
    kinds = {"float64": "f8", "int64": "i8", "uint32": "i8"}
    columns = [found.column(c.name) for c in CHANNELS]
    rows = np.empty(columns[0].size, [(c.name, kinds[c.dtype]) for c in CHANNELS])
    for c, values in zip(CHANNELS, columns, strict=True):
        rows[c.name] = values
    return rows


def batches(rows: Array) -> Iterator[tuple[Array, bool]]:
    """Rows in batches, and whether it is time for a sync."""
    for i, start in enumerate(range(0, len(rows), BATCH)):
        yield rows[start : start + BATCH], i % SYNC == SYNC - 1


def journal(rows: Array, folder: Path) -> None:
    """As the recorder writes them: Arrow, a checksum for each batch."""
    layout = schema("sim")
    for old in folder.glob("journal-*"):
        old.unlink()
    writer = JournalWriter(folder, layout, 0)
    for batch, sync in batches(rows):
        writer.append(columns_of_rows(batch))
        if sync:
            writer.sync()
    writer.close()


def raw(rows: Array, folder: Path) -> None:
    """The bytes of the rows and nothing else."""
    with open(folder / "raw", "wb", buffering=0) as file:
        for batch, sync in batches(rows):
            file.write(batch.tobytes())
            if sync:
                os.fdatasync(file.fileno())


def hdf5(rows: Array, folder: Path) -> None:
    """A dataset per channel, grown by each batch, flushed so that a reader sees it."""
    with h5py.File(folder / "rows.h5", "w") as file:
        sets = {
            name: file.create_dataset(name, (0,), rows.dtype[name], maxshape=(None,), chunks=(4096,))
            for name in rows.dtype.names or ()
        }
        for batch, _ in batches(rows):
            for name, one in sets.items():
                one.resize(one.shape[0] + len(batch), axis=0)
                one[-len(batch) :] = batch[name]
            file.flush()


@final
class Recording(Row):
    """13 channels, the rig's table, of a real slow run on the twin; the peers write the same 13.

    Found: what the journal costs beside raw bytes is one Arrow batch each 0.2 s (its columns, their message, their
    checksum), the same whatever the rate; longer batches would cost less and lose more in a power cut. Mended: NaN is
    looked for in all columns at once, and columns are made of the bytes as they lie, slices of one buffer; the
    checksum takes the columns that were made and not new ones of the batch; the fifty pieces Arrow writes of a batch
    are gathered on its side, where each was a call into Python. The same bytes for 0.84 of the CPU time.
    """

    number: ClassVar[int] = 10
    name: ClassVar[str] = "recording all channels at 1 kHz: CPU per row; archive size; one-channel read"
    against: ClassVar[str] = "raw binary append; HDF5; MDF4"

    def measure(self, rounds: Rounds) -> list[Figure]:
        with tempfile.TemporaryDirectory() as root:
            seconds = rounds.size(200, 10)
            folder = run(KinematicError(frequency=2.0 / seconds, amplitude_deg=7.2 * seconds), Path(root)).folder
            rows, place = rows_of(folder), Path(root)
            writers = {"ours": journal, "raw": raw, "hdf5": hdf5}
            cost = take_turns({k: cpu(self._write(w, rows, place)) for k, w in writers.items()}, rounds.count)
            return [
                ratio("CPU time per row over raw append", cost["ours"], cost["raw"], AtMost(8.0)),
                ratio("CPU time per row over HDF5 flushed each batch", cost["ours"], cost["hdf5"], AtMost(0.15)),
                *self._archive(rows, place, folder, rounds),
                self._hand_over(rounds),
            ]

    def _write(self, writer: Callable[[Array, Path], None], rows: Array, place: Path) -> Callable[[], None]:
        return lambda: writer(rows, place)

    def _archive(self, rows: Array, place: Path, folder: Path, rounds: Rounds) -> list[Figure]:
        layout = schema("sim")
        write_archive(place, [pa.Table.from_batches(list(JournalReader(place)), layout)], layout)
        path, size = place / NAME, rows.nbytes
        export(Run.open(folder), "mdf4", place / "run.mf4")
        reads = {"one": cpu(lambda: pq.read_table(path, columns=["theta_l"])), "all": cpu(lambda: pq.read_table(path))}
        cost = take_turns(reads, 5 * rounds.count)
        return [
            Figure("archive over raw bytes", [path.stat().st_size / size], AtMost(0.30)),
            Figure("MDF4 of the same run over raw bytes", [(place / "run.mf4").stat().st_size / size], Shown()),
            ratio("one channel over a full read", cost["one"], cost["all"], AtMost(0.20)),
        ]

    def _hand_over(self, rounds: Rounds) -> Figure:
        sample = Sample(0.1, 1.2, 0.02, 1.0, 0.5, 0.4, 1e-4, 1234, 5678, 1, "")

        def pack() -> None:
            for _ in range(PUTS):
                ROW.pack(0.1, 1.2, 0.02, 1.0, 0.5, 0.4, 1e-4, 0.3, 0.3, 1.2, 1234, 5678, 1)

        def put() -> None:
            ring = Ring.create()
            try:
                for _ in range(PUTS):
                    ring.put(sample, 0.3, 0.3, 1.2)
            finally:
                ring.close()
                ring.unlink()

        cost = take_turns({"put": cpu(put), "pack": cpu(pack)}, rounds.count)
        return ratio("handing a row to the recorder over struct.pack of it", cost["put"], cost["pack"], Shown())
