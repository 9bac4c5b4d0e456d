"""A run that lies in two folders, as a copy or by a link, is one run: no repeat of itself, and it is said."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from rig.catalogue import compare, trend
from rig.cli import main
from rig.core.errors import UsageError
from tests.catalogue.folders import run


@pytest.fixture
def twice(tmp_path: Path) -> tuple[Path, Path]:
    """Two runs in `tmp_path`, the first linked to and copied as well."""
    a, b = run(tmp_path, "2026-11-20", 0, 90.0), run(tmp_path, "2026-11-20", 1, 95.0)
    (tmp_path / "a-link").symlink_to(a)
    shutil.copytree(a, a.parent / "zz-copy")
    return a, b


def test_a_trend_has_no_repeat_in_a_copy(tmp_path: Path, twice: tuple[Path, Path]) -> None:
    found = trend(tmp_path, "peak-to-peak")
    assert [spot.figure.value for spot in found.series[0].spots] == [90.0, 95.0]
    assert found.series[0].scatter.repeats == 2
    assert len(found.copies) == 2
    assert all("it is the same run as" in said for said in found.copies)
    assert found.as_json()["copies"] == list(found.copies)


def test_a_comparison_takes_a_run_once_and_finds_no_repeat_in_its_copy(
    tmp_path: Path, twice: tuple[Path, Path]
) -> None:
    a, b = twice
    found = compare([a, tmp_path / "a-link", b], tmp_path)
    assert [row.path for row in found.rows] == [a, b]
    assert found.remarks == (f"a-link counts once: it is the same run as {a.name} (uid 2026-11-20-0)",)
    assert "no repeats" in found.lines[0].differences[1].how  # type: ignore[union-attr]
    with pytest.raises(UsageError, match="compare was given one run 2 times: a-link counts once"):
        compare([a, tmp_path / "a-link"])


def test_a_list_has_each_run_once_and_says_which_folders_it_passes_by(
    tmp_path: Path, twice: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["list", str(tmp_path), "--json"]) == 0
    told = capsys.readouterr()
    assert len(told.out.splitlines()) == 2
    assert told.err.count("it is the same run as") == 2
    assert f"left out: {tmp_path / 'a-link'}: it is the same run as" in told.err


def test_runs_without_a_uid_are_told_apart_by_where_they_are(tmp_path: Path, twice: tuple[Path, Path]) -> None:
    folders = [run(tmp_path, "2026-11-21", k, uid="") for k in range(2)]
    (tmp_path / "b-link").symlink_to(folders[0])
    assert len(trend(tmp_path, "peak-to-peak").copies) == 3
