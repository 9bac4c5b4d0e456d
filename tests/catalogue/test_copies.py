"""A run that lies in two folders, as a copy or by a link, is one run: no repeat of itself, and it is said."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from rig.catalogue import compare, runs, trend
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
    (tmp_path / "empty").mkdir()
    with pytest.raises(UsageError, match=r"empty is not a run folder: it has no manifest\.json"):
        compare([tmp_path / "empty"])
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


@pytest.fixture
def copied(tmp_path: Path) -> tuple[Path, Path]:
    """A run of ours and a copy beside it whose name comes first."""
    made = run(tmp_path, "2026-11-20", 0, 90.0, uid="3f9c0123")
    original = made.rename(made.parent / "0147-kinematic-error-SN1-3f9c")
    copy = made.parent / "0000-copy"
    shutil.copytree(original, copy)
    return original, copy


def test_of_a_copied_run_every_verb_takes_the_original(
    tmp_path: Path, copied: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    original, copy = copied
    run(tmp_path, "2026-11-20", 1, 95.0)
    assert main(["list", str(tmp_path), "--gear", "SN1", "--json"]) == 0
    told = capsys.readouterr()
    assert (str(original) in told.out, str(copy) in told.out) == (True, False)
    assert f"left out: {copy}: it is the same run as {original.name}" in told.err
    assert trend(tmp_path, "peak-to-peak").series[0].spots[0].row.path == original
    assert runs(tmp_path)[0].path == original


def test_the_original_takes_the_place_of_its_copy(copied: tuple[Path, Path]) -> None:
    original, copy = copied
    other = run(original.parents[1], "2026-11-20", 1, 95.0)
    assert [row.path for row in compare([copy, other, original]).rows] == [original, other]


def test_repeats_are_looked_for_where_the_runs_lie_and_nowhere_beyond(tmp_path: Path) -> None:
    a, b = run(tmp_path / "a", "2026-11-20", 0, 90.0), run(tmp_path / "b", "2026-11-20", 1, 95.0)
    run(tmp_path / "c", "2026-11-20", 2, 91.0), run(tmp_path / "c", "2026-11-20", 3, 92.0)
    assert "no repeats" in compare([a, b]).lines[0].differences[1].how  # type: ignore[union-attr]
    run(tmp_path / "a", "2026-11-21", 4, 91.0), run(tmp_path / "b", "2026-11-21", 5, 92.0)
    assert "among 2 repeats" in compare([a, b]).lines[0].differences[1].how  # type: ignore[union-attr]
