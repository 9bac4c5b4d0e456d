"""Runs that a campaign's book calls done and that are no more: a folder deleted, renamed or damaged meanwhile."""

from __future__ import annotations

from rig.campaign.journal import LOST, Journal
from rig.core.errors import Exit
from rig.runfile.doubt import unreadable
from rig.runfile.planned import done_runs


def lost_runs(journal: Journal) -> dict[int, str]:
    """Numbers, from 0, of the runs that are gone or cannot be read, and a sentence for each. Changes nothing."""
    found = {}
    for number, name, folder in done_runs(journal.folder, journal.book):
        if folder is None:
            found[number - 1] = f"run {number} is to be made again: its folder {name} is gone"
        elif why := unreadable(folder):
            found[number - 1] = f"run {number} is to be made again: its folder {folder.name} cannot be used: {why}"
    return found


def still_to_make(journal: Journal, lost: dict[int, str]) -> list[int]:
    """Numbers of the runs that are open once those `lost` count as not made."""
    return sorted({*journal.open_runs(), *lost})


def give_up(journal: Journal) -> list[str]:
    """Write down which runs are lost, and where those lie that were renamed; the same in sentences. Raises
    RecorderError."""
    told = []
    for number, name, folder in done_runs(journal.folder, journal.book):
        if folder is not None and folder.name != name:
            journal.moved(number - 1, folder.name)
            told.append(f"run {number} lies in {folder.name} now, it was {name}")
    for index, said in lost_runs(journal).items():
        journal.lose(index, said)
        told.append(said)
    return told


def lacking(journal: Journal) -> Exit:
    """INCOMPLETE where a run that was lost is not made again, for somebody has it skipped; else PASS."""
    skipped = [entry["attempts"] for entry in journal.book["runs"] if entry["status"] == "skipped"]
    gone = any(attempts and attempts[-1]["status"] == LOST for attempts in skipped)
    return Exit.INCOMPLETE if gone else Exit.PASS
