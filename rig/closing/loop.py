"""Round after round on one session: the open runs, a trace of all runs, the run it asks for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from rig.analysis.tracing.answer import NextRun, Status
from rig.analysis.tracing.fit.channels import SENSOR_NAMES
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.selection.next_run import along
from rig.campaign.journal import Journal
from rig.campaign.planner import Campaign
from rig.campaign.run import Desk, make_runs
from rig.closing.advice import Advice, advised, same
from rig.closing.grow import grown
from rig.closing.story import SETTLED, End, Round, Story, left, settled_by, told_by, write_story
from rig.core.errors import Exit, NotReady, UsageError
from rig.report.numbers import counted
from rig.session import Session

Look = Callable[[Path], Trace]
"""From the campaign's folder to what its runs say. Raises HdrigError."""


@dataclass
class Closing:
    """One loop in the making. `minutes` tells the rig time of the campaign so far."""

    session: Session
    campaign: Campaign
    journal: Journal
    desk: Desk
    look: Look
    minutes: Callable[[], float]
    story: Story

    def close(self) -> Story:
        """Rounds until one of the ends. What was found is on disk after each of them.

        Raises HdrigError when the runs cannot be traced or the campaign's book cannot be written.
        """
        while self.story.end is End.OPEN:
            exit = make_runs(self.session, self.campaign, self.journal, self.desk)
            if exit is not Exit.PASS:
                return self.ended(End.STOPPED, "A run came to no end; --resume goes on with it.")
            self._round()
        return self.story

    def _round(self) -> None:
        self.desk.say("tracing all runs so far")
        known = sum(len(r.made) for r in self.story.rounds)
        made = [item.words() for item in self.campaign.items[known:]]
        found = told_by(self.look(self.journal.folder), len(self.story.rounds) + 1, made, self.minutes())
        self.desk.say(words(found))
        if (end := settled_by(found)) is not None:  # also where somebody asked to stop meanwhile: nothing is left to do
            self._with(found)
            self.ended(end, found.sentence)
            return
        self._advise(found)
        if self.story.end is End.OPEN and self.session.interrupts.count:
            self.ended(End.STOPPED, "Stopped by the operator; --resume goes on with it.")

    def _advise(self, found: Round) -> None:
        """Put the run asked for behind the others, or end with the reason why not."""
        before = self.story.rounds[-1].asked if self.story.rounds else None
        asked, end = _asked(found), End.UNDECIDED if found.status is Status.AMBIGUOUS else End.UNKNOWN
        sentence = _said(found)
        if asked is None:
            self._with(found)
            self.ended(end, f"{sentence} No run is known that would say more.")
            return
        found = replace(found, asked=asdict(asked))
        if same(asked, before):
            self._with(found)
            self.ended(end, f"{sentence} The run that was to decide was made, and did not.")
            return
        try:
            advice = advised(asked, self.campaign)
        except (UsageError, NotReady) as error:
            self._with(replace(found, refused=str(error)))
            self.ended(End.UNDECIDED, f"{sentence} The run that would decide cannot be made: {error}.")
            return
        self._take(replace(found, plan=advice.text, words=advice.words), advice)

    def _take(self, found: Round, advice: Advice) -> None:
        left = self.story.budget_minutes - self.minutes()
        if advice.rig_time / 60 > left:
            why = f"it takes {advice.rig_time / 60:.1f} min of rig time, {max(left, 0.0):.1f} min are left"
            self._with(replace(found, plan="", refused=why))
            self.ended(End.BUDGET, f"{_said(found)} The run that would decide was not made: {why}.")
            return
        assert found.asked is not None
        self._with(found)
        self.campaign = grown(self.campaign, self.journal, advice.items, found.asked["because"])
        self.desk.say(f"next: {advice.words}, {advice.rig_time / 60:.1f} min at most; {found.asked['because']}")

    def _with(self, found: Round) -> None:
        self.story = replace(self.story, rounds=(*self.story.rounds, found))
        write_story(self.journal.folder, self.story)

    def ended(self, end: End, sentence: str) -> Story:
        """The loop has come to that end; written down."""
        self.story = replace(self.story, end=end, sentence=sentence)
        write_story(self.journal.folder, self.story)
        return self.story


def _asked(found: Round) -> NextRun | None:
    """The run the trace asks for; beside a name that leaves a channel above its floor, the one along what is left."""
    if found.asked:
        return NextRun(**found.asked)
    return next((run for c in found.lives_in if (run := along(c)) is not None), None) if left(found) else None


def _said(found: Round) -> str:
    """The trace's sentence, and what it does not cover."""
    rest = left(found) if found.status in SETTLED else ""
    return f"{found.sentence} {rest}".rstrip()


def words(found: Round) -> str:
    """A round in a few lines."""
    before, after = found.over_floor_before, found.over_floor_after
    errors = ", ".join(
        f"{word} {before[c]:.2f} → {after[c]:.2f}" for c, word in SENSOR_NAMES.items() if c in before and c in after
    )
    parts = f" ({counted(found.in_part, 'part')} of fitted runs among them)" if found.in_part else ""
    runs = f"{counted(found.fitted, 'run')} fitted and {found.held_out} held out{parts}"
    return (
        f"round {found.number}, {found.minutes:.1f} min of rig time, {runs}: {found.status.replace('_', ' ')}\n"
        f"  {_said(found)}\n  held-out error over its floor: {errors}"
    )
