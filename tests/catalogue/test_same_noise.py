"""Two runs whose samples are the same to the last bit are no repeats: the twin with one seed makes its noise again."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rig.catalogue.compare import compare
from rig.catalogue.trend import trend
from rig.core.errors import UsageError
from rig.evaluation.to_identify import open_runs
from tests.catalogue.test_doubt import RESULT
from tests.commands.made_run import made_run, rows


@pytest.fixture
def again(tmp_path: Path) -> list[Path]:
    """A run, the same once more under another uid, and one of its own."""
    folders = [made_run(tmp_path / name, table=rows(seed)) for name, seed in (("one", 1), ("same", 1), ("other", 2))]
    for folder in folders:
        (folder / "result.json").write_text(json.dumps(RESULT))
    return folders


def test_a_trend_counts_them_once_and_says_so(again: list[Path]) -> None:
    found = trend(again[0].parent, "kinematic_error_peak_to_peak")
    (series,) = found.series
    assert len(series.spots) == 2
    (said,) = found.copies
    assert "its samples are those of " in said
    assert "--seed N" in said


def test_two_folders_of_one_name_are_told_apart(tmp_path: Path) -> None:
    folders = [made_run(tmp_path / day / "run", table=rows(1)) for day in ("monday", "tuesday")]
    runs, _, said = open_runs(folders, lambda text: None)
    assert [run.path for run in runs] == folders[:1]
    assert [f"its samples are those of {folders[0]} to the last bit" in s for s in said] == [True]


def test_compared_with_each_other_they_are_one(again: list[Path]) -> None:
    with pytest.raises(UsageError, match=r"one run 2 times: same counts once: its samples are those of one "):
        compare(again[:2])
    assert compare([again[0], again[2]]).remarks == ()


def test_a_gear_is_identified_from_one_of_them(again: list[Path]) -> None:
    runs, _, said = open_runs(again, lambda text: None)
    assert [run.name for run in runs] == ["one", "other"]
    assert [s.startswith("same is left out: its samples are those of one to the last bit") for s in said] == [True]
