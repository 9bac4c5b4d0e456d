"""One run that cannot be opened ends no identification: it is named, and the others say what they say."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.core.errors import UsageError
from rig.evaluation.identification import open_runs, opened
from tests.commands.made_run import made_run


def test_a_run_that_cannot_be_opened_is_left_out_in_words(tmp_path: Path) -> None:
    good, bad = made_run(tmp_path / "good"), made_run(tmp_path / "bad", {"gear": {"ratio": "fifty"}})
    said: list[str] = []
    assert [run.name for run in opened([bad, good], said.append)] == ["good"]
    assert said == ['bad is left out: manifest.json: gear.ratio is "fifty", expected a number above 0']


def test_none_that_can_be_opened_is_refused_as_the_first_one_is(tmp_path: Path) -> None:
    bad = made_run(tmp_path / "bad", {"gear": {"ratio": "fifty"}})
    with pytest.raises(UsageError, match=r"gear\.ratio is \"fifty\""):
        opened([bad], lambda text: None)


def test_a_lock_test_whose_output_turns_is_left_out_in_words(tmp_path: Path) -> None:
    good = made_run(tmp_path / "good")
    turns = made_run(tmp_path / "turns", {"procedure": "stiffness_lock", "conditions": {"output_locked": True}})
    said: list[str] = []
    runs, recordings = open_runs([good, turns], said.append)
    assert [run.name for run in runs] == [r.name for r in recordings] == ["good"]
    assert len(said) == 1
    assert said[0].startswith("turns is left out: it says its output is locked, and its load angle goes")
