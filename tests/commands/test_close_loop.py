"""What close-loop says at its end: a path to copy, and one round is one round."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from rig.bench import read
from rig.campaign.journal import new_journal, read_journal
from rig.campaign.plan import read_plan
from rig.campaign.planner import planned
from rig.cli import main
from rig.closing.story import End, Story, read_story, told_by, write_story
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
    close_loop._tell(folder, story, Exit.STOPPED)
    said = capsys.readouterr()
    assert "after 0 rounds: Stopped" in said.out
    assert shlex.split(said.err)[:4] == ["hdrig", "close-loop", "--resume", str(folder)]


def test_every_round_leaves_the_trace_and_its_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = made_up.nothing()
    monkeypatch.setattr("rig.analysis.tracing.trace.trace", lambda folder: made)
    monkeypatch.setattr(trace_page, "render", lambda trace, origin: "page")
    assert trace_folder(tmp_path) is made
    assert {path.name for path in tmp_path.iterdir()} == {"trace.json", "report.html"}


def test_a_round_that_is_stopped_while_its_page_is_made_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The figures of the new trace lay beside the page of the old one."""

    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("rig.analysis.tracing.trace.trace", lambda folder: made_up.nothing())
    monkeypatch.setattr(trace_page, "render", stopped)
    (tmp_path / "trace.json").write_text("of before")
    with pytest.raises(KeyboardInterrupt):
        trace_folder(tmp_path)
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("trace.json", "of before")]


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


def ended(folder: Path, end: End) -> None:
    """The loop in `folder` with every run made and that end."""
    journal = read_journal(folder)
    for index in journal.open_runs():
        journal.end(index, "done", "completed")
    write_story(folder, Story(folder.name, True, 12.0, end, "The verdict."))


@pytest.mark.parametrize(("end", "exit"), [(End.EXPLAINED, Exit.PASS), (End.UNKNOWN, Exit.INCOMPLETE)])
def test_a_finished_loop_is_told_as_it_ended_and_nothing_is_moved(
    end: End, exit: Exit, begun: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ended(begun, end)
    before = (begun / "close-loop.json").read_bytes()
    monkeypatch.setattr(close_loop, "_make", lambda *given: pytest.fail("it goes on"))
    assert main(["close-loop", "--resume", str(begun)]) == exit
    said = capsys.readouterr()
    assert "this loop is finished: nothing is moved" in said.err
    assert f"loop {end} after 0 rounds: The verdict." in said.out
    assert (begun / "close-loop.json").read_bytes() == before
    assert read_journal(begun).book["status"] == "completed"


def test_a_loop_stopped_after_its_trace_had_settled_it_says_the_verdict_at_once(
    begun: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ended(begun, End.STOPPED)
    story = read_story(begun)
    settled = told_by(made_up.nothing(), 1, ("standstill",), 4.0)
    write_story(begun, replace(story, rounds=(settled,)))
    monkeypatch.setattr(close_loop, "_make", lambda *given: pytest.fail("it moves"))
    assert main(["close-loop", "--resume", str(begun)]) == Exit.PASS
    said = capsys.readouterr()
    assert "this loop is finished: nothing is moved" in said.err
    assert f"loop nothing missing after 1 round: {settled.sentence}" in said.out
    assert read_story(begun).end is End.NOTHING


def test_a_finished_loop_with_a_run_that_is_gone_makes_it_again(begun: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ended(begun, End.EXPLAINED)
    journal = read_journal(begun)
    journal.end(0, "done", "completed", begun / "0820-gone-abcd")
    made: list[list[int]] = []
    monkeypatch.setattr(close_loop, "_make", lambda *given: made.append(given[1].open_runs()) or 0)
    assert main(["close-loop", "--resume", str(begun), "--budget-minutes", "60"]) == Exit.PASS
    assert made == [[0]]


def test_a_folder_that_does_not_exist_is_said_not_to(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["close-loop", "--resume", str(tmp_path / "nosuch")]) == Exit.USAGE
    assert capsys.readouterr().err == f"hdrig: {tmp_path / 'nosuch'} does not exist\n"


def test_a_loop_that_ended_for_its_budget_goes_on_with_more_of_it(begun: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ended(begun, End.BUDGET)
    made: list[object] = []
    monkeypatch.setattr(close_loop, "_make", lambda *given: made.append(given) or 0)
    for words in ([], ["--budget-minutes", "12"]):
        assert main(["close-loop", "--resume", str(begun), *words]) == Exit.INCOMPLETE
    assert made == []
    assert main(["close-loop", "--resume", str(begun), "--budget-minutes", "30"]) == Exit.PASS
    assert len(made) == 1
