"""A loop is not closed while the trace's own report says that a channel is not explained."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.answer import NextRun, Status, Verdict
from rig.analysis.tracing.outcome.result import Before, Errors, Trace
from rig.closing import loop
from rig.closing.advice import Advice
from rig.closing.loop import Closing, words
from rig.closing.story import End, Story, left, told_by


def found(status: Status, after: dict[str, float], lives_in: tuple[str, ...] = (), asked: Any = None) -> Trace:
    """A trace of that verdict."""
    none = Errors(None, None, None)
    verdict = Verdict(status, (), (), None, None, None, f"It is {status}.")
    return Trace(
        "small", True, ("a",), ("b",), "", (), (), (), (), {}, dict.fromkeys(after, 9.0), after, lives_in, (), verdict,
        (), Before({}, none), Before({}, none), asked, (), (),
    )  # fmt: skip


def closing(folder: Path, *traces: Trace) -> Closing:
    """A loop whose rig is not asked for anything but the time."""
    looks = iter(traces)
    made: Any = SimpleNamespace(words=lambda: "run")
    session: Any = SimpleNamespace(interrupts=SimpleNamespace(count=0))
    journal: Any = SimpleNamespace(folder=folder)
    desk: Any = SimpleNamespace(say=lambda text: None)
    campaign: Any = SimpleNamespace(items=(made,))
    return Closing(session, campaign, journal, desk, lambda folder: next(looks), lambda: 1.0, Story("c", True, 60.0))


def test_a_name_that_leaves_a_channel_above_its_floor_does_not_close_the_loop(tmp_path: Path) -> None:
    loop = closing(tmp_path, found(Status.EXPLAINED, {"theta_l": 1.5, "tau_m": 1.1}))
    loop._round()
    assert loop.story.end is End.UNKNOWN
    assert "Not all of it: the kinematic error stays at 1.50 times its floor" in loop.story.sentence
    assert loop.story.sentence.endswith("No run is known that would say more.")


def test_what_is_left_is_looked_for_along_where_it_lives_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loop, "advised", lambda asked, campaign: Advice((), 60.0, "plan"))
    monkeypatch.setattr(loop, "grown", lambda campaign, journal, items, why: campaign)
    loud = found(Status.EXPLAINED, {"theta_l": 1.5}, ("load_angle",))
    made = closing(tmp_path, loud, loud)
    made._round()
    assert made.story.end is End.OPEN
    assert made.story.rounds[0].asked is not None
    assert made.story.rounds[0].asked["procedure"] == "full_turn"
    made._round()
    assert made.story.end is End.UNKNOWN
    assert made.story.sentence.endswith("The run that was to decide was made, and did not.")


def test_a_name_that_leaves_nothing_closes_it(tmp_path: Path) -> None:
    loop = closing(tmp_path, found(Status.EXPLAINED, {"theta_l": 1.25, "tau_m": 1.0}))
    loop._round()
    assert (loop.story.end, loop.story.sentence) == (End.EXPLAINED, "It is explained.")


def test_what_a_trace_asks_for_goes_before_where_it_lives() -> None:
    asked = NextRun("sentinel", {}, "it decides")
    told = told_by(found(Status.EXPLAINED, {"theta_l": 1.5}, ("load",), asked), 1, (), 1.0)
    assert loop._asked(told) == asked
    quiet = told_by(found(Status.EXPLAINED, {"theta_l": 1.0}, ("load",)), 1, (), 1.0)
    assert loop._asked(quiet) is None


def test_what_is_said_of_a_round_names_every_channel_and_counts_in_words() -> None:
    told = told_by(found(Status.EXPLAINED, {"theta_l": 1.5, "tau_l": 2.0}), 1, (), 1.0)
    assert left(told) == (
        "Not all of it: the kinematic error stays at 1.50 times its floor and the shaft torque stays at 2.00 times its "
        "floor, and what that is, is not known."
    )
    assert "1 run fitted and 1 held out:" in words(told)


def test_parts_of_fitted_runs_are_told_so_that_the_numbers_add_up() -> None:
    parted = replace(found(Status.EXPLAINED, {}), fitted=("slow", "lock"), held_out=("slow 2", "lock (part held out)"))
    told = told_by(parted, 1, (), 1.0)
    assert "2 runs fitted and 2 held out (1 part of fitted runs among them)" in words(told)
