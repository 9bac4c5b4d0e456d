"""What close-loop says at its end: a path to copy, and one round is one round."""

from __future__ import annotations

import shlex
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rig.bench import read
from rig.campaign.journal import new_journal
from rig.campaign.plan import read_plan
from rig.campaign.planner import planned
from rig.cli import main
from rig.closing.story import End, Story, write_story
from rig.commands import close_loop
from rig.core.errors import Exit
from rig.evaluation.trace import trace_folder
from rig.report.trace import page as trace_page
from tests.report.trace import made_up


def test_the_folder_to_go_on_with_can_be_copied_whatever_its_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "Prüfstand 1"
    folder.mkdir()
    story = Story("c", True, 60.0, End.STOPPED, "Stopped by the operator.")
    write_story(folder, story)
    bench: Any = SimpleNamespace(simulated=True)
    close_loop._tell(folder, story, bench, Exit.STOPPED)
    said = capsys.readouterr()
    assert "after 0 rounds: Stopped" in said.out
    assert shlex.split(said.err)[:4] == ["hdrig", "close-loop", "--resume", str(folder)]


def test_every_round_leaves_the_trace_and_its_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = made_up.nothing()
    monkeypatch.setattr("rig.analysis.tracing.trace.trace", lambda folder: made)
    monkeypatch.setattr(trace_page, "render", lambda trace, origin: "page")
    assert trace_folder(tmp_path) is made
    assert {path.name for path in tmp_path.iterdir()} == {"trace.json", "report.html"}


@pytest.fixture
def begun(tmp_path: Path) -> Path:
    """The folder of a loop on the twin that was stopped before its first run, with 12 min to go on."""
    campaign = planned(read_plan("quick"), read("twin"), 1)
    journal = new_journal(tmp_path, campaign, "virtual", [])
    write_story(journal.folder, Story(journal.folder.name, True, 12.0, End.STOPPED, "Stopped by the operator."))
    journal.close("stopped", "Stopped by the operator.")
    return journal.folder


@pytest.mark.parametrize(("words", "minutes"), [([], 12.0), (["--budget-minutes", "30"], 30.0)])
def test_a_resumed_loop_keeps_its_budget_unless_another_is_asked_for(
    words: list[str], minutes: float, begun: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[Story] = []
    monkeypatch.setattr(close_loop, "_make", lambda *given: made.append(given[4]) or 0)
    assert main(["close-loop", "--resume", str(begun), *words]) == Exit.PASS
    assert [story.budget_minutes for story in made] == [minutes]
