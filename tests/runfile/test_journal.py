"""The journal when it is torn, damaged, restarted; and the archive made from it."""

from __future__ import annotations

import itertools
import os
import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rig.core.channels import CHANNEL
from rig.runfile.archive import row_groups, write_archive
from rig.runfile.columns import checksum, columns_of_rows, schema
from rig.runfile.journal import JournalReader, JournalWriter
from rig.runfile.remains import journal_files
from tests.runfile.rows import expected, new_folder, ring_of, write_journal

OURS = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=40)


def rows_of(folder: Path) -> int:
    """Whole rows, each of them checked to be what was put."""
    batches = list(JournalReader(folder))
    if not batches:
        return 0
    table = pa.Table.from_batches(batches)
    want = expected(table.num_rows)
    for name in ("t", "theta_m", "tau_l", "flags"):
        np.testing.assert_array_equal(table.column(name).cast(pa.float64()).to_numpy(), want[name])
    return int(table.num_rows)


def ends_of(path: Path, batch: int, rows: int) -> list[int]:
    """Where in the file each whole batch ends, found by reading ever longer beginnings of it."""
    with pa.OSFile(str(path)) as source:
        stream = pa.ipc.open_stream(source)
        ends = []
        for _ in range(1 + rows // batch):  # the first is empty: it carries the schema
            stream.read_next_batch()
            ends.append(source.tell())
    return ends


@pytest.mark.slow
def test_a_file_cut_at_any_byte_of_its_last_batch_loses_that_batch_and_nothing_else(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    path = write_journal(folder, 0, 60, batch=20)
    ends = ends_of(path, 20, 60)
    assert path.stat().st_size == ends[-1]
    for cut in range(ends[-1] - 1, ends[-2] - 1, -1):
        os.truncate(path, cut)
        reader = JournalReader(folder)
        assert sum(batch.num_rows for batch in reader) == 40
        assert reader.torn_bytes == cut - ends[-2]
    assert rows_of(folder) == 40


@pytest.mark.slow
def test_a_file_cut_anywhere_gives_every_batch_before_the_cut(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    path = write_journal(folder, 0, 200, batch=20)
    data, ends = path.read_bytes(), ends_of(path, 20, 200)
    for cut in random.Random(1).sample(range(len(data) + 1), 300):
        path.write_bytes(data[:cut])
        assert rows_of(folder) == 20 * max(sum(end <= cut for end in ends) - 1, 0)


@pytest.mark.slow
def test_a_file_the_power_cut_filled_with_zeros_ends_where_it_was_whole(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    path = write_journal(folder, 0, 100, batch=20)
    data, ends = path.read_bytes(), ends_of(path, 20, 100)
    for kept in random.Random(2).sample(range(ends[-2], ends[-1]), 200):
        path.write_bytes(data[:kept].ljust(ends[-1] + 4096, b"\0"))
        assert rows_of(folder) in (80, 100)  # 100: the zeros happened to be padding, the checksum says so


@pytest.mark.slow
def test_no_damaged_value_passes_for_a_measured_one(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    path = write_journal(folder, 0, 100, batch=20)
    data, ends, dice = path.read_bytes(), ends_of(path, 20, 100), random.Random(3)
    for _ in range(300):
        spoilt = bytearray(data)
        for _ in range(dice.randrange(1, 20)):
            spoilt[dice.randrange(ends[0], len(data))] ^= 1 << dice.randrange(8)
        path.write_bytes(spoilt)
        assert rows_of(folder) % 20 == 0  # and rows_of compares every value


def test_a_second_journal_goes_on_where_the_first_was_torn(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    first = write_journal(folder, 0, 100)
    first.write_bytes(first.read_bytes()[:-10])
    write_journal(folder, 50, 180)
    reader = JournalReader(folder)
    assert sum(batch.num_rows for batch in reader) == reader.next_row == 180
    assert reader.missing == 0
    assert reader.torn_bytes > 0
    assert rows_of(folder) == 180


def test_rows_that_two_journals_both_have_are_given_once(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    write_journal(folder, 0, 100)
    write_journal(folder, 70, 130, batch=25)
    assert rows_of(folder) == 130


def test_rows_that_no_journal_has_are_counted(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    write_journal(folder, 0, 100)
    write_journal(folder, 120, 130)
    reader = JournalReader(folder)
    assert sum(batch.num_rows for batch in reader) == 110
    assert (reader.missing, reader.next_row) == (20, 130)


def test_a_journal_closed_properly_has_nothing_torn(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    write_journal(folder, 0, 100, close=True)
    reader = JournalReader(folder)
    assert sum(batch.num_rows for batch in reader) == 100
    assert reader.torn_bytes == 0


def test_anybody_can_read_a_closed_journal_with_its_units(tmp_path: Path) -> None:
    path = write_journal(new_folder(tmp_path), 0, 100, close=True)
    with pa.OSFile(str(path)) as source:
        table = pa.ipc.open_stream(source).read_all()
    assert table.num_rows == 100
    for field in table.schema:
        channel = CHANNEL[field.name]
        assert field.metadata == {b"unit": channel.unit.encode(), b"meaning": channel.meaning.encode()}
        assert str(field.type).replace("double", "float64") == channel.dtype
    assert table.schema.metadata[b"simulated"] == b"true"


@pytest.mark.slow
@given(st.integers(0, 200), st.integers(0, 200))
def test_a_batch_has_the_same_checksum_before_and_after_the_file(start: int, rows: int) -> None:
    ring = ring_of(start + rows)
    columns = columns_of_rows(ring.read(start, start + rows))
    batch = pa.RecordBatch.from_arrays(columns, schema=schema("sim"))
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, batch.schema) as stream:
        stream.write_batch(batch)
    read = pa.ipc.open_stream(sink.getvalue()).read_next_batch() if rows else batch
    assert checksum(read.columns, start) == checksum(columns, start) != checksum(columns, start + 1)
    ring.unlink()
    ring.close()


def slow_rows(rows: int) -> pa.RecordBatch:
    """Rows a second apart: 60 to a row group; some without a torque."""
    ring = ring_of(rows)
    made = ring.read(0, rows)
    made["t"] = np.arange(rows) * 1.0
    ring.unlink()
    ring.close()
    return pa.RecordBatch.from_arrays(columns_of_rows(made), schema=schema("sim"))


def archive_of(folder: Path, batches: list[pa.RecordBatch]) -> bytes:
    """The bytes of the file made from these batches."""
    write_archive(folder, row_groups(batches), schema("sim"))
    return (folder / "samples.parquet").read_bytes()


@pytest.mark.slow
@OURS
@given(cuts=st.lists(st.integers(0, 400), max_size=30))
def test_the_same_samples_give_the_same_bytes_whatever_the_batches_were(tmp_path: Path, cuts: list[int]) -> None:
    whole = slow_rows(400)
    bounds = [0, *sorted(cuts), 400]
    pieces = [whole.slice(a, b - a) for a, b in itertools.pairwise(bounds)]
    assert archive_of(tmp_path, pieces) == archive_of(tmp_path, [whole])


def test_a_row_group_is_a_minute_and_a_column_is_read_alone(tmp_path: Path) -> None:
    archive_of(tmp_path, [slow_rows(150)])
    file = pq.ParquetFile(tmp_path / "samples.parquet")
    assert [file.metadata.row_group(i).num_rows for i in range(file.metadata.num_row_groups)] == [60, 60, 30]
    column = file.metadata.row_group(0).column(1)
    assert (column.path_in_schema, column.compression) == ("theta_m", "ZSTD")
    assert "BYTE_STREAM_SPLIT" in column.encodings


def test_time_that_stands_still_or_is_absent_still_gives_groups_of_bounded_size(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rig.runfile.archive.GROUP_ROWS", 100)
    batch = slow_rows(250)
    none = batch.set_column(0, batch.schema.field("t"), pa.nulls(250, pa.float64()))
    assert [table.num_rows for table in row_groups([none.slice(0, 130), none.slice(130)])] == [100, 100, 50]


def test_the_extent_is_rows_and_seconds(tmp_path: Path) -> None:
    assert write_archive(tmp_path, row_groups([slow_rows(130)]), schema("sim")) == (130, 129.0)
    assert write_archive(tmp_path, row_groups([]), schema("sim")) == (0, 0.0)
    assert not journal_files(tmp_path)


@pytest.mark.parametrize("harm", [lambda path: path.unlink(), lambda path: os.truncate(path, 10)])
def test_a_journal_removed_or_cut_while_it_is_written_is_noticed(tmp_path: Path, harm: Callable[[Path], None]) -> None:
    journal = JournalWriter(tmp_path, schema("sim"), 0)
    harm(journal.path)
    with pytest.raises(OSError, match="removed or cut it"):
        journal.sync()
    with pytest.raises(OSError, match="removed or cut it"):
        journal.close()
