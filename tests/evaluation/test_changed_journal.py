"""A journal that stands in for samples.parquet, and is not what it was, is analysed with a word on it."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.evaluation.run import analyse_folder, changed_journal
from rig.runfile import manifest
from rig.runfile.finalise import finalise
from tests.runfile.rows import new_folder, write_journal

pytestmark = pytest.mark.usefixtures("no_pictures")


@pytest.mark.slow
def test_a_shortened_journal_is_named_with_the_rows_that_are_gone_and_meets_no_limit(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    write_journal(folder, 0, 300, close=False)
    write_journal(folder, 300, 600, close=True)
    finalise(folder, "completed", "end", timing={"missed": 0}, expected_rows=600)
    assert changed_journal(folder, manifest.read(folder)) == ""
    (folder / "samples.parquet").unlink()
    assert changed_journal(folder, manifest.read(folder)) == ""
    last = max(folder.glob("journal-*.arrows"))
    data = last.read_bytes()
    last.unlink()
    last.write_bytes(data[: len(data) // 2])
    result, _ = analyse_folder(folder, folder)
    told = next(check for check in result.checks if check.name == "as_recorded")
    assert not told.passed
    assert f"samples.parquet is gone, and {last.name} is not what it was" in told.sentence
    assert "of the 600 rows this run was closed with are missing" in told.sentence
    assert told.sentence in (folder / "result.json").read_text()
