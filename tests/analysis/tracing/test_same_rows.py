"""A copied folder is no repeat of what it was copied from."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from rig.analysis.tracing.runs.campaign import read_campaign

SOME = ("slow_ke_1", "slow_ke_2", "speed_200rpm_1")


@pytest.mark.parametrize(("began", "is_left_out"), [(None, True), ("2026-11-03T09:00:00+00:00", False)])
def test_a_copy_begun_at_the_same_time_is_left_out(
    shared: Path, tmp_path: Path, began: str | None, is_left_out: bool
) -> None:
    for name in SOME:
        shutil.copytree(shared / "cases" / "open-1" / name, tmp_path / name)
    copy = tmp_path / "slow_ke_1_copy"
    shutil.copytree(tmp_path / "slow_ke_1", copy)
    if began:  # what a plant without noise does twice is done twice
        manifest = json.loads((copy / "manifest.json").read_text())
        (copy / "manifest.json").chmod(0o644)
        (copy / "manifest.json").write_text(json.dumps(manifest | {"started_utc": began}))
    found = read_campaign(tmp_path)
    assert (copy.name in found.left_out) is is_left_out
    said = [note for note in found.notes if copy.name in note]
    assert bool(said) is is_left_out
    assert all("the same rows as slow_ke_1" in note for note in said)
    assert {run.name for run in found.runs} >= set(SOME)


@pytest.mark.parametrize("began", [None, "2026-11-03T09:00:00+00:00"])
def test_a_copy_of_which_nobody_says_when_it_began_or_that_all_began_at_once_is_left_out(
    shared: Path, tmp_path: Path, began: str | None
) -> None:
    """Manifests of other loggers need not say it."""
    for name in SOME:
        shutil.copytree(shared / "cases" / "open-1" / name, tmp_path / name)
        manifest = json.loads((tmp_path / name / "manifest.json").read_text())
        del manifest["started_utc"]
        (tmp_path / name / "manifest.json").chmod(0o644)
        (tmp_path / name / "manifest.json").write_text(json.dumps(manifest | ({"started_utc": began} if began else {})))
    shutil.copytree(tmp_path / "slow_ke_1", tmp_path / "slow_ke_1_copy")
    found = read_campaign(tmp_path)
    assert found.left_out == ("slow_ke_1_copy",)
    assert any("it holds the same rows as slow_ke_1" in note for note in found.notes)
