"""A closed run without its samples: the journal beside it gives them back, or a sentence says why not."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest

from rig.core.errors import DataError
from rig.runfile import manifest
from rig.runfile.finalise import finalise
from rig.runfile.recover import recover
from rig.runfile.verify import verify
from tests.runfile.test_finalise import ended_run


def closed(root: Path) -> Path:
    folder = ended_run(root)
    finalise(folder, "stopped", "by the operator")
    return folder


def test_samples_that_are_gone_come_back_from_the_journal_and_the_status_stays(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    before = pq.read_table(folder / "samples.parquet")
    (folder / "samples.parquet").unlink()
    told = recover(folder)
    assert (told.rows, told.changed) == (500, True)
    assert "made anew from the journal, 500 rows" in told.sentence
    assert pq.read_table(folder / "samples.parquet").equals(before)
    assert manifest.read(folder)["status"] == "stopped"
    assert [f for f in verify(folder) if f.level == "error"] == []
    assert not recover(folder).changed


def test_samples_that_were_changed_are_not_overwritten_and_the_way_out_is_said(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    path = folder / "samples.parquet"
    path.chmod(0o644)
    path.write_bytes(path.read_bytes()[:1000])
    with pytest.raises(DataError, match="is not overwritten; move it away, and hdrig recover"):
        recover(folder)
    assert path.stat().st_size == 1000
    path.rename(tmp_path / "broken.parquet")
    assert recover(folder).rows == 500


def test_without_a_journal_or_with_another_one_nothing_is_made_up(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    (folder / "samples.parquet").unlink()
    journal = folder / "journal-0001.arrows"
    journal.chmod(0o644)
    journal.write_bytes(journal.read_bytes()[:-64])
    with pytest.raises(DataError, match="is not what it was"):
        recover(folder)
    journal.unlink()
    with pytest.raises(DataError, match="no journal to make it from"):
        recover(folder)
    assert not (folder / "samples.parquet").exists()


def test_changed_samples_without_a_journal_promise_no_recovery(tmp_path: Path) -> None:
    folder = closed(tmp_path)
    path = folder / "samples.parquet"
    path.chmod(0o644)
    path.write_bytes(path.read_bytes()[:1000])
    (folder / "journal-0001.arrows").unlink()
    with pytest.raises(
        DataError, match="no journal to make it anew from: the file it was has to come from a copy"
    ) as e:
        recover(folder)
    assert "hdrig recover" not in str(e.value)
