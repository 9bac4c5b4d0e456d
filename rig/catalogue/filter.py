"""Which runs are listed, and in which order."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any

from rig.catalogue.row import NO_LIMIT, UNREADABLE, Row, moment
from rig.core.errors import UsageError
from rig.core.nearest import nearest

VERDICTS = ("PASS", "FAIL", "INCONCLUSIVE", NO_LIMIT, "none")
SAME = {"measured": NO_LIMIT}  # the word of manifests and of --json
STATUSES = ("running", "completed", "stopped", "tripped", "interrupted", UNREADABLE)
EARLIEST = datetime.min.replace(tzinfo=UTC)

ORDERS: dict[str, Callable[[Row], Any]] = {
    "started": lambda row: row.started or EARLIEST,
    "procedure": lambda row: row.procedure,
    "gear": lambda row: row.gear,
    "status": lambda row: row.status,
    "verdict": lambda row: row.ruling,
    "duration": lambda row: -1.0 if row.duration is None else row.duration,
}


@dataclass(frozen=True)
class Filter:
    """What a run must be; "" and None ask nothing. Build one from words with `asked`."""

    gear: str = ""  # serial, * and ? stand for anything
    procedure: str = ""  # with underscores
    verdict: str = ""
    status: str = ""
    since: datetime | None = None
    until: datetime | None = None  # not included
    sort: str = "started"
    reverse: bool = False

    def passes(self, row: Row) -> bool:
        """Whether `row` is one of them. What a damaged manifest does not say is not what was asked for."""
        return (
            (not self.gear or fnmatch.fnmatchcase(row.gear, self.gear))
            and (not self.procedure or row.procedure.replace("-", "_") == self.procedure)
            and (not self.verdict or (row.ruling or "none") == self.verdict)
            and (not self.status or row.status == self.status)
            and self._in_time(row)
        )

    def of(self, found: Iterable[Row]) -> list[Row]:
        """Those that pass, in order."""
        return sorted(filter(self.passes, found), key=self.key, reverse=self.reverse)

    def key(self, row: Row) -> tuple[Any, datetime, str]:
        """What `row` is sorted by; equal ones by time and name."""
        return ORDERS[self.sort](row), row.started or EARLIEST, row.path.name

    def _in_time(self, row: Row) -> bool:
        if self.since is None and self.until is None:
            return True
        when = row.started
        if when is None:
            return False
        return (self.since is None or when >= self.since) and (self.until is None or when < self.until)


ALL = Filter()


def asked(
    *,
    gear: str = "",
    procedure: str = "",
    verdict: str = "",
    status: str = "",
    since: str = "",
    until: str = "",
    sort: str = "started",
    reverse: bool = False,
) -> Filter:
    """The filter somebody wrote in words. Raises UsageError for a verdict, status, order or date that there is not."""
    return Filter(
        gear=gear,
        procedure=procedure.replace("-", "_"),
        verdict=_one_of("verdict", SAME.get(verdict.lower(), verdict), VERDICTS),
        status=_one_of("status", status, STATUSES),
        since=_when("since", since),
        until=_end("until", until),
        sort=_one_of("order", sort, tuple(ORDERS)) or "started",
        reverse=reverse,
    )


def _one_of(what: str, word: str, known: tuple[str, ...]) -> str:
    for name in known:
        if word.lower() == name.lower():
            return name
    if word:
        raise UsageError(f"there is no {what} '{word}'; {nearest(word, known)}")
    return ""


def _when(what: str, said: str) -> datetime | None:
    if not said:
        return None
    found = moment(said)
    if found is None:
        raise UsageError(f"--{what} {said}: expected a date as 2026-11-20, or date and time as 2026-11-20T14:30 (UTC)")
    return found


def _end(what: str, said: str) -> datetime | None:
    """The end of a day that is named, or of the minute, second that is."""
    found = _when(what, said)
    if found is None:
        return None
    step = timedelta(days=1) if len(said) <= len("2026-11-20") else timedelta(minutes=1 if said.count(":") == 1 else 0)
    try:
        return found + (step or timedelta(seconds=1))
    except OverflowError:
        return None
