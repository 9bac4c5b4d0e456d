"""A campaign from the page: a plan on the bench that is connected, prompts to the page, figures by a process aside."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, final

from rig.campaign import summary
from rig.campaign.journal import Journal, new_journal, read_journal, record_of, refuse_other_campaign
from rig.campaign.leaving import swept
from rig.campaign.plan import read_plan
from rig.campaign.planner import Campaign, any_seed, planned
from rig.campaign.resume import take_up
from rig.campaign.run import Desk, conduct
from rig.campaign.steps import Item
from rig.campaign.sweeps import plan_named
from rig.core.errors import DataError, Exit, NotReady
from rig.runfile.folder import create, create_in
from rig.runfile.manifest import told
from rig.session import Session, Watch
from rig.session.done import nobody
from rig.station.analysis import AFTERWARDS, ANALYSE, Analysis
from rig.station.station import Station, forget


def conduct_plan(station: Station, message: Mapping[str, Any]) -> None:
    """Every run of the plan that is open; its folder is closed, with its status, on every way out."""
    session = station.need()
    resumed = message.get("resume")
    journal, campaign = _resumed(station, session, Path(str(resumed))) if resumed else _new(station, session, message)
    station.busy(f"campaign {campaign.plan.file.name}")
    desk = PageDesk(station, campaign, journal)
    session.root, session.create, session.checks = journal.folder, create_in, "checks"
    session.note = journal.note(str(message.get("note") or ""))
    station.keep = lambda text: journal.tell(f"note: {text}")
    try:
        with swept(journal):
            exit = conduct(session, campaign, journal, desk)
    finally:
        session.root, session.create, session.checks = station.root, create, ""
        session.facts, session.note, station.keep = {}, "", forget
    text = "\n".join(summary.lines(journal)) + "\n"
    with told(NotReady, f"the summary cannot be written into {journal.folder}"):
        (journal.folder / "summary.txt").write_text(text, encoding="utf-8")
    station.teller.say("said", f"campaign {journal.book['status']}: {journal.book['sentence']}; {journal.folder}")
    if exit is Exit.PASS:
        _afterwards(station, desk, journal)


def _afterwards(station: Station, desk: PageDesk, journal: Journal) -> None:
    """The page of a sweep, or the gear file, as `hdrig campaign` ends with it."""
    station.busy(f"figures of campaign {journal.book['name']}")
    found = desk.wait(Analysis(journal.folder, AFTERWARDS))
    if found["report"] is not None:
        station.status.last_run = {
            "uid": journal.book["uid"], "title": f"campaign {journal.book['name']}", "status": "completed",
            "reason": journal.book["sentence"], "folder": str(journal.folder), **found,
        }  # fmt: skip
        station.teller.say("finding", str(found["sentence"]))
    elif (gear := journal.folder / "gear.toml").exists():
        station.teller.say("finding", f"gear file {gear}")
    elif found["sentence"]:
        raise DataError(str(found["sentence"]))


def _new(station: Station, session: Session, message: Mapping[str, Any]) -> tuple[Journal, Campaign]:
    plan = plan_named(str(message.get("plan", "")), message.get("parameters") or {})
    campaign = planned(plan, session.bench, any_seed())
    overrides = (station.status.bench or {}).get("overrides", [])
    journal = new_journal(station.root, campaign, session.clock, overrides)
    journal.book["rigging"] = session.rigging.conditions()  # as it stands: weight and pin come off first
    if station.pending is not None:
        journal.book["pending"] = record_of(station.pending)
    return journal, campaign


def _resumed(station: Station, session: Session, folder: Path) -> tuple[Journal, Campaign]:
    """With the plan, bench and seed it began with. Raises UsageError where those are others."""
    journal = read_journal(folder)
    plan = read_plan(str(folder / "plan.toml"))
    campaign = planned(plan, session.bench, journal.book["seed"])
    refuse_other_campaign(journal, campaign)
    for line in take_up(journal):
        station.teller.say("said", line)
    return journal, campaign


@final
class PageDesk(Desk):
    """Tells the page where the campaign is."""

    def __init__(self, station: Station, campaign: Campaign, journal: Journal) -> None:
        self.station, self.campaign, self.journal = station, campaign, journal
        self._current = "proof and tare"
        self._tell(self._current)

    def say(self, text: str) -> None:
        self.station.teller.say("said", text)
        self._tell(self._current)  # what is said follows upon something that was done

    @contextlib.contextmanager
    def watching(self, item: Item, duration: float) -> Iterator[Watch]:
        self._tell(item.words(), measuring=True)
        yield nobody
        self._tell(item.words())

    def again(self, why: str) -> bool:
        person = self.station.person
        return person is not None and person.ask(f"{why}: do it once more", "Again")

    def figure(self, folder: Path) -> str:
        found = self.wait(Analysis(folder, ANALYSE))
        last = self.station.status.last_run
        if last is not None:
            self.station.status.last_run = last | found
        if found["report"] is None:
            raise DataError(str(found["sentence"]))
        return str(found["sentence"])

    def wait(self, analysis: Analysis) -> dict[str, Any]:
        """What it found; the station goes on attending meanwhile. Raises DataError when somebody ends it."""
        while not analysis.done:
            self.station.attend()
            if self.station.panel.count > 1 or self.station.channel.closed:
                analysis.end()
                raise DataError("left for later: hdrig analyse makes its figures")
        return analysis.found()

    def _tell(self, current: str, measuring: bool = False) -> None:
        self._current, left = current, self.journal.open_runs()
        seconds = sum(self.campaign.envelope(self.campaign.items[k]).duration for k in left)
        total = len(self.campaign.items)
        self.station.status.campaign = {
            "plan": self.campaign.plan.file.name, "done": total - len(left), "total": total, "current": current,
            "left_s": seconds, "measuring": measuring, "folder": str(self.journal.folder),
        }  # fmt: skip
        self.station.told()
