"""A session on the twin whose operator may lie, forget, or grip the wrong weight."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

from rig.bench import read
from rig.campaign.journal import Journal, new_journal
from rig.campaign.planner import Campaign
from rig.campaign.run import Desk, conduct, open_session
from rig.campaign.steps import Item
from rig.core.errors import Exit
from rig.core.operator import Change, Operator
from rig.process.interrupts import Interrupts
from rig.session import Session, Watch


class Liar(Operator):
    """Makes `instead` where something is to be made; says it is done."""

    def __init__(self, honest: Operator, instead: dict[Change, Change | None]) -> None:
        self.honest, self.instead = honest, instead
        self.asked: list[Change] = []

    def make(self, change: Change) -> None:
        self.asked.append(change)
        really = self.instead.get(change, change)
        if really is not None:
            self.honest.make(really)


@contextmanager
def session(root: Path, *overrides: str, instead: dict[Change, Change | None] | None = None) -> Iterator[Session]:
    with Session(read("twin", overrides), "virtual", root, Interrupts()) as opened:
        assert opened.instruments.operator is not None
        opened.instruments.operator = Liar(opened.instruments.operator, instead or {})
        yield opened


class Quiet(Desk):
    """Keeps what it is told. Run `stop_at`, from 1, is asked to stop; during run `trip_at` the drive trips."""

    def __init__(self, rig: Session, stop_at: int = 0, requests: int = 1, trip_at: int = 0) -> None:
        self.rig, self.interrupts = rig, rig.interrupts
        self.stop_at, self.requests, self.trip_at = stop_at, requests, trip_at
        self.said: list[str] = []
        self.begun: list[Item] = []

    def say(self, text: str) -> None:
        self.said.append(text)

    def watching(self, item: Item, duration: float) -> AbstractContextManager[Watch]:
        self.begun.append(item)
        number = len(self.begun)

        @contextmanager
        def watching() -> Iterator[Watch]:
            yield lambda sample: self._look(number)

        return watching()

    def _look(self, number: int) -> None:
        if number == self.trip_at:
            self.rig.instruments.drive.trip("it is too hot")  # type: ignore[attr-defined]
        if number == self.stop_at and not self.interrupts.count:
            for _ in range(self.requests):
                self.interrupts.request()

    def figure(self, folder: Path) -> str:
        return f"figure of {folder.name}"


def make(root: Path, campaign: Campaign, **desk: int) -> tuple[Exit, Journal, Quiet]:
    """A new campaign, to whatever end."""
    return go_on(new_journal(root, campaign, "virtual", []), campaign, **desk)


def go_on(
    journal: Journal, campaign: Campaign, instead: dict[Change, Change | None] | None = None, **desk: int
) -> tuple[Exit, Journal, Quiet]:
    """A campaign that was begun, to whatever end."""
    with open_session(campaign, journal, "virtual", Interrupts()) as opened:
        assert opened.instruments.operator is not None
        opened.instruments.operator = Liar(opened.instruments.operator, instead or {})
        quiet = Quiet(opened, **desk)
        return conduct(opened, campaign, journal, quiet), journal, quiet
