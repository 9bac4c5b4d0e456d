"""Figures of a run whose samples are no longer those they were made from are shown with that word beside them."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest

from rig.catalogue.compare import compare
from rig.catalogue.trend import trend
from rig.cli import main
from tests.commands.made_run import made_run

FIGURE = {"label": "Peak to peak", "value": 90.0, "unit": "arcsec", "ci95": [89.0, 91.0], "how": "made up"}
RESULT = {"schema": "hdrig.result/1", "verdict": "PASS", "estimates": {"kinematic_error_peak_to_peak": FIGURE}}


def analysed(folder: Path, **change: object) -> Path:
    made_run(folder, change=change)
    (folder / "result.json").write_text(json.dumps(RESULT))
    return folder


def changed(path: Path) -> None:
    """One byte of it, and its time as of an edit."""
    data = bytearray(path.read_bytes())
    data[1000] ^= 1
    path.write_bytes(data)
    os.utime(path, ns=(path.stat().st_atime_ns, path.stat().st_mtime_ns + 10**9))


@pytest.fixture
def pair(tmp_path: Path) -> tuple[Path, Path]:
    return analysed(tmp_path / "a"), analysed(tmp_path / "b")


def listed(root: Path, capsys: pytest.CaptureFixture[str]) -> str:
    assert main(["list", str(root)]) == 0
    return capsys.readouterr().out


def test_runs_that_are_as_they_were_are_in_no_doubt(
    pair: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert compare(pair).remarks == ()
    assert "doubt" not in listed(pair[0].parent, capsys)


def test_changed_samples_are_said_beside_the_figures(
    pair: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    changed(pair[1] / "samples.parquet")
    said = "samples.parquet is not what it was when the run was closed or analysed (see hdrig verify)"
    assert compare(pair).remarks == (f"b: its figures are not to be believed: {said}",)
    a, b = listed(pair[0].parent, capsys).splitlines()[1:]
    assert "doubt" not in a
    assert b.endswith(f"  (figures in doubt: {said})")


def test_samples_that_are_gone_or_torn_without_a_hash_are_too(
    pair: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    (pair[0] / "samples.parquet").unlink()
    about = json.loads((pair[1] / "manifest.json").read_text())
    del about["files"]
    (pair[1] / "manifest.json").write_text(json.dumps(about))
    (pair[1] / "samples.parquet").write_bytes(b"PAR1 torn")
    gone, torn = compare(pair).remarks
    assert gone == "a: its figures are not to be believed: it has no samples: neither samples.parquet nor a journal"
    assert torn.startswith("b: its figures are not to be believed: samples.parquet")
    assert "figures in doubt: it has no samples" in listed(pair[0].parent, capsys)


def test_a_result_that_was_edited_is_too(pair: tuple[Path, Path]) -> None:
    about = json.loads((pair[0] / "manifest.json").read_text())
    about["files"]["result.json"] = {"sha256": "0" * 64, "derived": True}
    (pair[0] / "manifest.json").write_text(json.dumps(about))
    assert compare(pair).remarks[0].startswith("a: its figures are not to be believed: result.json is not what it was")


def test_a_trend_leaves_out_a_run_in_doubt_and_takes_the_copy_of_one_that_is_in_none(tmp_path: Path) -> None:
    def taken() -> set[str]:
        return {spot.row.path.name for series in trend(tmp_path, "peak-to-peak").series for spot in series.spots}

    first, second = analysed(tmp_path / "a", uid="one"), analysed(tmp_path / "b", uid="two")
    shutil.copytree(first, tmp_path / "z")
    taken_first = (taken() - {"b"}).pop()  # of two copies whichever the disk names first
    (other,) = {"a", "z"} - {taken_first}
    changed(tmp_path / taken_first / "samples.parquet")
    assert taken() == {other, "b"}
    found = trend(tmp_path, "peak-to-peak")
    assert found.left_out == 0
    said = f"its figures are in doubt, those of its copy {tmp_path / other} are not: samples.parquet is not what it was"
    assert found.copies[0].startswith(f"{taken_first} is left out: {said}")
    changed(second / "samples.parquet")
    assert taken() == {other}
    said = trend(tmp_path, "peak-to-peak").copies[0]
    assert said.startswith("b is left out: its figures are in doubt: samples.parquet is not what it was")
