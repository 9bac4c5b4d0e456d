"""Rounds on the twin with a trace that says what the test wants: what is run, written down and refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from rig.analysis.tracing.answer import NextRun, Status, Verdict
from rig.analysis.tracing.outcome.result import Before, Errors, Trace
from rig.analysis.tracing.selection.next_run import along
from rig.bench import read
from rig.campaign.journal import Journal, new_journal, read_journal
from rig.campaign.plan import parse_plan
from rig.campaign.planner import Campaign, planned
from rig.campaign.resume import take_up
from rig.campaign.run import open_session
from rig.closing.grow import regrown
from rig.closing.loop import Closing
from rig.closing.run import conduct
from rig.closing.story import End, Story, read_story
from rig.core.errors import Exit, UsageError
from rig.process.interrupts import Interrupts
from rig.report.closing.page import write
from tests.campaign.rigs import Quiet

pytestmark = [pytest.mark.slow, pytest.mark.long]
PLAN = """schema = "hdrig.plan/1"
name = "small"
[[step]]
procedure = "standstill"
with = { duration = 0.5 }
"""
REST = NextRun("standstill", {"duration": 0.5}, "it shows the noise")


def saying(status: Status, asked: NextRun | None = None) -> Trace:
    """A trace of that verdict."""
    none = Errors(None, None, None)
    verdict = Verdict(status, (), (), None, None, None, f"It is {status}.")
    return Trace(
        "small", True, ("a",), ("b",), "", (), (), (), (), {}, {"theta_l": 2.0}, {"theta_l": 1.0}, (), (), verdict, (),
        Before({}, none), Before({}, none), asked, (), (),
    )  # fmt: skip


def loop(root: Path, traces: Iterator[Trace], budget: float = 60.0, stop_at: int = 0) -> tuple[Exit, Closing]:
    """A loop on a twin, from its beginning."""
    campaign = planned(parse_plan(PLAN, "small.toml"), read("twin"), 1)
    journal = new_journal(root, campaign, "virtual", [])
    return go(campaign, journal, Story(journal.folder.name, True, budget), lambda folder: next(traces), stop_at)


def go(
    campaign: Campaign, journal: Journal, story: Story, look: Callable[[Path], Trace], stop_at: int = 0
) -> tuple[Exit, Closing]:
    with open_session(campaign, journal, "virtual", Interrupts()) as session:
        clock = session.instruments.clock
        desk = Quiet(session, stop_at)
        closing = Closing(session, campaign, journal, desk, look, lambda: clock.now() / 60, story)
        return conduct(closing), closing


def runs(journal: Journal) -> list[str]:
    return [f"{entry['procedure']} {entry['status']}" for entry in journal.book["runs"]]


def test_the_run_that_is_asked_for_is_made_in_the_same_folder_and_decides(tmp_path: Path) -> None:
    exit, closing = loop(tmp_path, iter([saying(Status.AMBIGUOUS, REST), saying(Status.EXPLAINED)]))
    assert (exit, closing.story.end) == (Exit.PASS, End.EXPLAINED)
    assert runs(closing.journal) == ["standstill done"] * 3
    assert [len(r.made) for r in closing.story.rounds] == [1, 2]
    assert closing.story.rounds[1].minutes > closing.story.rounds[0].minutes
    assert read_story(closing.journal.folder) == closing.story
    assert len(list(closing.journal.folder.glob("*/manifest.json"))) == 3
    page = write(closing.journal.folder).read_text()
    assert "Round 2: explained" in page
    assert "it shows the noise" in page
    assert "SIMULATED" in page


def test_a_run_that_did_not_decide_is_not_made_for_ever(tmp_path: Path) -> None:
    exit, closing = loop(tmp_path, iter([saying(Status.AMBIGUOUS, REST)] * 3))
    assert (exit, closing.story.end) == (Exit.INCOMPLETE, End.UNDECIDED)
    assert len(closing.story.rounds) == 2
    assert "did not" in closing.story.sentence


def test_what_is_unknown_is_looked_for_along_the_coordinate_it_lives_in(tmp_path: Path) -> None:
    _, closing = loop(tmp_path, iter([saying(Status.UNKNOWN, along("load_angle"))]), budget=1.0)
    assert closing.story.rounds[0].asked is not None
    assert closing.story.rounds[0].asked["procedure"] == "full_turn"
    assert closing.story.end is End.BUDGET


def test_what_is_unknown_with_nothing_to_ask_for_ends_as_unknown(tmp_path: Path) -> None:
    exit, closing = loop(tmp_path, iter([saying(Status.UNKNOWN)]))
    assert (exit, closing.story.end) == (Exit.INCOMPLETE, End.UNKNOWN)


def test_a_trace_that_breaks_off_is_told_and_can_be_taken_up(tmp_path: Path) -> None:
    def broken(folder: Path) -> Trace:
        raise UsageError("no run to fit")

    campaign = planned(parse_plan(PLAN, "small.toml"), read("twin"), 1)
    journal = new_journal(tmp_path, campaign, "virtual", [])
    exit, closing = go(campaign, journal, Story(journal.folder.name, True, 60.0), broken)
    assert (exit, closing.story.end) == (Exit.USAGE, End.STOPPED)
    assert read_story(journal.folder).sentence == "no run to fit"
    assert runs(journal) == ["standstill done"]


def test_a_run_that_cannot_be_made_is_refused_in_words(tmp_path: Path) -> None:
    fast = NextRun("constant_torque", {"speed_rpm": 900.0}, "it is fast")
    _, closing = loop(tmp_path, iter([saying(Status.AMBIGUOUS, fast)]))
    assert closing.story.end is End.UNDECIDED
    assert "600" in closing.story.rounds[0].refused
    assert runs(closing.journal) == ["standstill done"]


def test_nothing_is_run_beyond_the_budget_of_rig_time(tmp_path: Path) -> None:
    exit, closing = loop(tmp_path, iter([saying(Status.AMBIGUOUS, REST)]), budget=0.3)
    assert (exit, closing.story.end) == (Exit.INCOMPLETE, End.BUDGET)
    assert runs(closing.journal) == ["standstill done"]


def test_what_a_trace_says_while_somebody_asks_to_stop_is_kept(tmp_path: Path) -> None:
    """A verdict ends the loop as ever; a run that is asked for is written down, to be made when it goes on."""

    def ended_by(found: Trace, root: Path) -> Closing:
        campaign = planned(parse_plan(PLAN, "small.toml"), read("twin"), 1)
        journal = new_journal(root, campaign, "virtual", [])
        with open_session(campaign, journal, "virtual", Interrupts()) as session:

            def look(folder: Path) -> Trace:
                session.interrupts.request()
                return found

            story = Story(journal.folder.name, True, 60.0)
            closing = Closing(session, campaign, journal, Quiet(session), look, session.instruments.clock.now, story)
            conduct(closing)
        return closing

    settled = ended_by(saying(Status.NOTHING), tmp_path / "settled")
    assert (settled.story.end, len(settled.story.rounds)) == (End.NOTHING, 1)
    asking = ended_by(saying(Status.AMBIGUOUS, REST), tmp_path / "asking")
    assert (asking.story.end, runs(asking.journal)) == (End.STOPPED, ["standstill done", *["standstill planned"] * 2])
    assert asking.story.rounds[0].plan


def test_a_loop_that_was_stopped_goes_on_where_it_was(tmp_path: Path) -> None:
    traces = iter([saying(Status.AMBIGUOUS, REST), saying(Status.NOTHING)])
    exit, closing = loop(tmp_path, traces, stop_at=2)
    assert (exit, closing.story.end) == (Exit.STOPPED, End.STOPPED)
    journal, story = read_journal(closing.journal.folder), read_story(closing.journal.folder)
    campaign = planned(parse_plan(PLAN, "small.toml"), read("twin"), 1)
    take_up(journal)
    campaign = regrown(campaign, journal, story)
    again, closing = go(campaign, journal, replace(story, end=End.OPEN), lambda folder: next(traces))
    assert (again, closing.story.end) == (Exit.PASS, End.NOTHING)
    assert runs(journal) == ["standstill done"] * 3
    assert [len(r.made) for r in closing.story.rounds] == [1, 2]
