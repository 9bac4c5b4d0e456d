"""The figures of a campaign's runs: each asked for once, and of a run whose analysis was killed when it goes on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rig.campaign.journal import Journal
from rig.core.errors import HdrigError

Say = Callable[[str], None]
Figure = Callable[[Path], str]
"""Analyses a run; its main figure in one sentence. Raises HdrigError."""


def write_figure(journal: Journal, index: int, folder: Path, figure: Figure, say: Say) -> None:
    """What the analysis says of a run, or why it says nothing, in the book."""
    try:
        told = figure(folder)
    except HdrigError as error:  # the run is whole; what it says can be asked again
        told = f"not analysed: {error}"
    journal.figure(index, told)
    say(told)


def write_missing_figures(journal: Journal, figure: Figure, say: Say) -> None:
    """Runs that are done and of which the book says nothing: the program was killed while it analysed them."""
    for index, entry in enumerate(journal.book["runs"]):
        if entry["status"] == "done" and entry["run"] and "figure" not in entry:
            say(f"run {index + 1} was made and not analysed: {entry['run']}")
            write_figure(journal, index, journal.folder / entry["run"], figure, say)
