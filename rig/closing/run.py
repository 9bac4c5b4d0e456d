"""One loop from a connected rig to its end: the campaign's book and the story closed on every way out."""

from __future__ import annotations

import contextlib

from rig.campaign.figures import write_missing_figures
from rig.campaign.journal import Journal
from rig.campaign.leaving import came_to_something
from rig.campaign.run import check_facts, settle
from rig.closing.loop import Closing
from rig.closing.story import End, Story
from rig.core.errors import Exit, HdrigError, RecorderError

EXITS = {End.NOTHING: Exit.PASS, End.EXPLAINED: Exit.PASS, End.STOPPED: Exit.STOPPED}


def conduct(closing: Closing) -> Exit:
    """Proof and tare, then the rounds. Returns the exit code: PASS when the loop is closed, INCOMPLETE when it is not.

    A rig that is told to stop, or an error, leaves both books so that --resume goes on. Raises HdrigError when it came
    to an end before anything was recorded.
    """
    session, journal = closing.session, closing.journal
    session.facts = check_facts(journal)
    exit, status, sentence, close = Exit.INTERNAL, "failed", "an internal error ended it", journal.fail
    try:
        write_missing_figures(journal, closing.desk.figure, closing.desk.say)
        settle(session, journal, closing.desk)
        story = closing.close()
        exit, sentence = exit_of(story), story.sentence
        status, close = "stopped" if story.end is End.STOPPED else "completed", journal.close
    except HdrigError as error:
        if not came_to_something(journal):
            raise
        exit, sentence = error.exit, str(error)
        status = "stopped" if session.interrupts.count else "failed"
        closing.desk.say(sentence)
        with contextlib.suppress(RecorderError):  # a full disk: what ended it is what is told
            closing.ended(End.STOPPED, sentence)
    finally:
        close(status, in_the_book(journal, sentence))
    return exit


def exit_of(story: Story) -> Exit:
    """How a loop with that story ends."""
    return EXITS.get(story.end, Exit.INCOMPLETE)


def in_the_book(journal: Journal, sentence: str) -> str:
    """What the campaign's book says of a loop that ended with `sentence`."""
    count = ", ".join(f"{number} {what}" for what, number in journal.count().items())
    return f"{count}; {sentence}"
