"""A campaign that came to nothing leaves nothing: its folder stays only where a run or a check was made in it."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from rig.campaign.journal import Journal
from rig.core.errors import HdrigError
from rig.runfile.listing import run_folders


def came_to_something(journal: Journal) -> bool:
    """Whether anything was recorded: a run, or a check that moved the rig."""
    return next(run_folders(str(journal.folder)), None) is not None


@contextlib.contextmanager
def swept(journal: Journal) -> Iterator[None]:
    """A rig that cannot be reached, or refuses before the first row, ends the campaign: written down where there is
    something to go on with, else the folder goes too. The error goes on to whoever asked.
    """
    try:
        yield
    except HdrigError as error:
        if came_to_something(journal):
            journal.fail("failed", str(error))
        else:
            _remove(journal)
            error.add_note(f"no run was made, so the campaign folder {journal.folder.name} is gone again")
        raise


def _remove(journal: Journal) -> None:
    """What `new_journal` and its caller wrote; a folder that cannot be emptied stays."""
    with contextlib.suppress(OSError):
        for path in journal.folder.iterdir():
            path.unlink()
        journal.folder.rmdir()
