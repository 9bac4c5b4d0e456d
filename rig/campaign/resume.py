"""What a campaign that ended, however, left behind: dead runs closed as interrupted, lost ones open again."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rig.campaign.journal import Journal
from rig.campaign.lost import give_up
from rig.core.errors import HdrigError, NotReady
from rig.runfile import manifest
from rig.runfile.finalise import is_closed
from rig.runfile.listing import run_folders
from rig.runfile.recover import recover

PATIENCE = 15.0  # s for the recorder of a killed program to write what it has and go


def take_up(journal: Journal) -> list[str]:
    """Claim the campaign, close what was being made when it died, open again what is lost; what was found, in
    sentences.

    Raises NotReady while another process makes it.
    """
    journal.reopen()
    told = []
    running = [k for k, entry in enumerate(journal.book["runs"], 1) if entry["status"] == "running"]
    for folder, about in unclosed(journal.folder):
        try:
            said = _closed(folder)
        except HdrigError as error:
            said = f"{folder.name} could not be closed: {error}"
        told.append(said)
        journal.tell(said)
        number = (about.get("campaign") or {}).get("run")
        if number in running:
            journal.end(number - 1, "interrupted", said, folder)
    for index, entry in enumerate(journal.book["runs"]):
        if entry["status"] == "running":  # it died before there was a folder
            journal.end(index, "interrupted", "it died before its first row")
    for said in give_up(journal):
        told.append(said)
        journal.tell(said)
    return told


def _closed(folder: Path) -> str:
    """Recover a run; its recorder, which outlives a killed program, is waited for."""
    give_up = time.monotonic() + PATIENCE
    while True:
        try:
            return recover(folder).sentence
        except NotReady:
            if time.monotonic() > give_up:
                raise
            time.sleep(0.2)


def unclosed(folder: Path) -> Iterator[tuple[Path, dict[str, Any]]]:
    """Runs in `folder` whose samples nobody put into their archive: killed, or killed while that was done."""
    for path in map(Path, run_folders(str(folder))):
        try:
            about = manifest.read(path)
        except HdrigError:
            continue
        if not is_closed(about):
            yield path, about
