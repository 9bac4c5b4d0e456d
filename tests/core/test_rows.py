"""Room for columns of any length."""

from __future__ import annotations

import errno
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rig.core import rows
from rig.core.errors import DataError


def own_bytes() -> int:
    """Memory of this process that is no file's."""
    with open("/proc/self/status", encoding="ascii", errors="replace") as file:
        return next(int(line.split()[1]) * 1024 for line in file if line.startswith("RssAnon"))


def test_a_long_column_takes_no_memory_of_the_program_and_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    before = own_bytes()
    column = rows.room(8 * rows.LONG)
    column[:] = np.pi
    assert column.size == 8 * rows.LONG
    assert own_bytes() - before < column.nbytes / 4
    assert float(column[::4096].sum()) == pytest.approx(np.pi * column.size / 4096)
    assert not list(tmp_path.iterdir())


def test_a_disk_without_room_is_said_before_anything_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(rows.os, "posix_fallocate", full)
    with pytest.raises(DataError, match=rf"16 MB, .* in {tmp_path} \(No space left on device\); TMPDIR names"):
        rows.room(2_000_000)


def test_a_folder_for_temporary_files_that_is_gone_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    with pytest.raises(DataError, match=rf"in {tmp_path}/gone \(No such file or directory\); TMPDIR names"):
        rows.room(2_000_000)


def test_stretches_are_all_rows_once_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows, "STRETCH", 7)
    assert [np.arange(16)[some].tolist() for some in rows.stretches(16)] == [
        [0, 1, 2, 3, 4, 5, 6],
        [7, 8, 9, 10, 11, 12, 13],
        [14, 15],
    ]
    assert not list(rows.stretches(0))
    wanted = np.array([15, 3, 3, 8, 0, 1, 2, 9, 9])
    assert rows.picked(np.arange(16.0), wanted).tolist() == wanted.tolist()
