"""A campaign from its first run to its end: every step written down before and after, so that it can be resumed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from rig.bench import ClockName
from rig.campaign.changes import bare, changes_between
from rig.campaign.figures import write_figure, write_missing_figures
from rig.campaign.journal import Journal
from rig.campaign.leaving import came_to_something
from rig.campaign.lost import lacking
from rig.campaign.planner import Campaign
from rig.campaign.steps import Item
from rig.campaign.unseen import unseen
from rig.core.errors import Exit, HdrigError, NotReady
from rig.core.operator import Change, FreeOutput, HangWeight, LockOutput, Operator, Rigging
from rig.process.interrupts import Interrupts
from rig.runfile.folder import create_in
from rig.session import Done, Session, Watch
from rig.session.observer import Observer
from rig.supervisor import State


class Desk(ABC):
    """Who looks on: told what happens, and asked for the figures of a run."""

    @abstractmethod
    def say(self, text: str) -> None:
        """One line for the person."""

    @abstractmethod
    def watching(self, item: Item, duration: float) -> AbstractContextManager[Watch]:
        """What is shown while a run goes on, for about `duration` s of rig time."""

    @abstractmethod
    def figure(self, folder: Path) -> str:
        """Analyse a run; its main figure in one sentence. Raises HdrigError."""

    def again(self, why: str) -> bool:
        """Whether somebody wants to make a change once more that could not be shown."""
        return False


def open_session(
    campaign: Campaign,
    journal: Journal,
    clock: ClockName,
    interrupts: Interrupts,
    note: str = "",
    hand: Operator | None = None,
    observer: Observer | None = None,
) -> Session:
    """The campaign's runs directly in its folder; proofs and weighings, which are no part of the data, beside them.

    `note` stands in the manifest of each of them.
    """
    return Session(
        campaign.bench,
        clock,
        journal.folder,
        interrupts,
        journal.note(note),
        hand,
        create=create_in,
        checks="checks",
        observer=observer or Observer(),
    )


def conduct(session: Session, campaign: Campaign, journal: Journal, desk: Desk) -> Exit:
    """Make every run of `journal` that is not settled yet. Its folder is closed, with its status, on every way out.

    Returns the exit code: PASS when every run was made, or skipped by somebody; INCOMPLETE when one that
    was skipped had been made and is lost. Raises HdrigError when it came to an end before anything was recorded.
    """
    exit, session.facts = Exit.INTERNAL, check_facts(journal)
    try:
        if session.simulated:  # over a wire only the devices can tell
            journal.of_the_twin()
        for told in unseen(campaign):
            desk.say(told)
            journal.tell(told)
        write_missing_figures(journal, desk.figure, desk.say)
        settle(session, journal, desk)
        exit = make_runs(session, campaign, journal, desk)
        status = {Exit.PASS: "completed", Exit.STOPPED: "stopped", Exit.HALTED: "stopped"}.get(exit, "failed")
        journal.close(status, _closing(journal))
        exit = exit or lacking(journal)
    except HdrigError as error:
        if not came_to_something(journal):
            raise
        exit = error.exit
        desk.say(str(error))
        journal.fail("stopped" if session.interrupts.count else "failed", str(error))
    return exit


def nothing_left(journal: Journal) -> bool:
    """Whether every run is settled and the rig is known to be bare: then there is nothing to move for."""
    return not journal.open_runs() and not to_bare(journal.rigging, journal.pending)


def close_settled(journal: Journal) -> Exit:
    """Close a campaign that was taken up with nothing left to make; INCOMPLETE where a lost run was skipped."""
    journal.close("completed", _closing(journal))
    return lacking(journal)


def check_facts(journal: Journal) -> dict[str, Any]:
    """What the manifests of proofs and weighings say: they tell later whether the encoders kept their zero."""
    return {"campaign": {"uid": journal.book["uid"], "kind": "check", "session": len(journal.book["sessions"])}}


def _closing(journal: Journal) -> str:
    count = journal.count()
    return ", ".join(f"{number} {status}" for status, number in count.items())


def settle(session: Session, journal: Journal, desk: Desk) -> None:
    """From a rig as it was left to one with nothing on it, proven and tared."""
    session.restore(journal.made, journal.rigging)
    for change in to_bare(journal.rigging, journal.pending):
        _by_hand(session, journal, desk, change)
    for told in (f"sign and scale: {session.prove().sentence}", *_tare(session)):
        desk.say(told)
        journal.tell(told)


def _tare(session: Session) -> list[str]:
    return [session.tare()] if session.instruments.torque_sensor is not None else []


def to_bare(rigging: Rigging, pending: Change | None) -> list[Change]:
    """What takes weight and pin off; of a change that was asked for and not shown nobody knows whether it was made."""
    found = changes_between(rigging, bare(rigging))
    match pending:
        case HangWeight() if not rigging.tau_ext:
            return [HangWeight(0.0)]
        case LockOutput() | FreeOutput() if not rigging.output_locked:
            return [FreeOutput(), *found]
        case _:  # a wave generator half fitted: the next run asks for it again, in an assembly of its own
            return found


def make_runs(session: Session, campaign: Campaign, journal: Journal, desk: Desk) -> Exit:
    """Every run of `journal` that is open, then weight and pin off; the first exit code that is none of a success."""
    worst = Exit.PASS
    for index in journal.open_runs():
        item = campaign.items[index]
        for change in changes_between(session.rigging, item.rigging):
            _by_hand(session, journal, desk, change)
        desk.say(f"run {index + 1} of {len(campaign.items)}: {item.words()}")
        exit = _measure(session, campaign, journal, desk, index)
        if exit is Exit.PASS:
            continue
        worst = worst or exit
        if session.interrupts.count or campaign.plan.file.on_failure == "stop":
            return exit
        if session.supervisor.state is State.FAULT:
            _clear(session, journal, desk)
    for change in changes_between(session.rigging, bare(session.rigging)):
        _by_hand(session, journal, desk, change)
    return worst


def _clear(session: Session, journal: Journal, desk: Desk) -> None:
    """After a trip somebody looks at the rig, pin and weight come off, and the proof is made anew."""
    why = session.supervisor.fault
    session.clear_fault()
    journal.tell(f"fault cleared by hand: {why}")
    for change in to_bare(session.rigging, None):
        _by_hand(session, journal, desk, change)
    desk.say(f"sign and scale: {session.prove().sentence}")


def _by_hand(session: Session, journal: Journal, desk: Desk, change: Change) -> None:
    """Raises NotReady when it is not made or not shown: no plan goes on from there."""
    desk.say(f"by hand: {change.words()}")
    former = journal.ask(change)
    try:
        shown = _shown(session, desk, change)
    except HdrigError:
        if not session.unsure:  # refused before anybody was asked: the rig is as it was
            journal.take_back(former)
        raise
    journal.show(change, session.rigging, shown)
    desk.say(shown)


def _shown(session: Session, desk: Desk, change: Change) -> str:
    """Asked for until it is shown, or nobody wants to try again. Raises NotReady with what the sensors show."""
    while True:
        try:
            return session.change(change)
        except NotReady as error:
            if session.interrupts.count or not desk.again(str(error)):
                raise


def _measure(session: Session, campaign: Campaign, journal: Journal, desk: Desk, index: int) -> Exit:
    """One run, whatever becomes of it written down."""
    item = campaign.items[index]
    note, checks = session.note, session.facts
    session.note = "; ".join(part for part in (note, item.note) if part)
    rig_time = journal.begin(index, session.instruments.clock.now())
    session.facts = {"campaign": {
        "uid": journal.book["uid"], "run": index + 1, "kind": item.kind, "repeat": item.repeat, "of": item.of,
        "rig_time_s": round(rig_time, 3), "session": len(journal.book["sessions"]),
        **({"way": item.way} if item.way else {}),
    }}  # fmt: skip
    try:
        with desk.watching(item, campaign.envelope(item).duration) as watch:
            done = session.run(item.procedure, watch)
    except HdrigError as error:
        status = "stopped" if session.interrupts.count else "failed"
        desk.say(f"run {status}: {error}")
        journal.end(index, status, str(error), session.folder)
        return error.exit
    finally:
        session.note, session.facts = note, checks
    return _ended(journal, desk, index, done)


def _ended(journal: Journal, desk: Desk, index: int, done: Done) -> Exit:
    statuses = {"completed": "done", "stopped": "stopped"}
    status = statuses.get(done.ending.status, "failed")
    journal.end(index, status, done.ending.reason, done.folder)
    if status != "done":
        desk.say(f"run {status}: {done.ending.reason}")
        return done.ending.exit
    write_figure(journal, index, done.folder, desk.figure, desk.say)
    return Exit.PASS
