"""One run in a list, from its manifest alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rig.core import numbers
from rig.runfile.manifest import digest_of, of_no_use
from rig.runfile.misfits import misfits, misfits_of_ours, notes, usable
from rig.runfile.origin import SIM

UNREADABLE = "unreadable"  # the status of a run whose manifest is damaged
NO_LIMIT = "no-limit"  # the verdict of figures nobody set a limit for; manifests say MEASURED, also of the twin's
ORIGINS = {"sim": "SIMULATED", "can": "MEASURED", "serial": "MEASURED", "imported": "IMPORTED"}  # by backend


@dataclass(frozen=True, slots=True)
class Row:
    """What is not known is "" or None."""

    path: Path
    uid: str = ""
    started_utc: str = ""  # ISO 8601, as the manifest says it
    procedure: str = ""  # or the label of a run that has one
    gear: str = ""  # serial
    status: str = ""  # of the manifest; "interrupted" for a run found dead, "unreadable" for a damaged manifest
    verdict: str = ""
    reason: str = ""  # why it ended
    duration: float | None = None  # s of samples
    rows: int | None = None
    backend: str = ""  # sim, can, serial, imported
    operator: str = ""
    campaign: str = ""  # uid
    conditions: Mapping[str, Any] = field(default_factory=dict)
    problem: str = ""  # what is wrong with its manifest, in words
    doubt: str = ""  # why its figures are not to be believed, in words
    digest: str = ""  # SHA-256 of its samples

    @property
    def simulated(self) -> bool:
        """True for the twin, also over a wire."""
        return self.backend == SIM

    @property
    def origin(self) -> str:
        """Where its samples came from: SIMULATED, MEASURED or IMPORTED; "" where the manifest does not say."""
        return ORIGINS.get(self.backend, "")

    @property
    def ruling(self) -> str:
        """The verdict as shown: PASS, FAIL, INCONCLUSIVE or no-limit; "" of a run that was not analysed."""
        return NO_LIMIT if self.verdict == "MEASURED" else self.verdict

    @property
    def started(self) -> datetime | None:
        """Start, UTC; None when the manifest does not say it as ISO 8601."""
        return moment(self.started_utc)

    def as_json(self) -> dict[str, Any]:
        """For programs: the same names, absent values as null."""
        named = {
            name: getattr(self, name) or None
            for name in ("uid", "started_utc", "procedure", "gear", "status", "verdict", "reason", "backend",
                         "operator", "campaign", "problem", "doubt")
        }  # fmt: skip
        return {
            **named,
            "duration_s": self.duration,
            "rows": self.rows,
            "simulated": self.simulated,
            "origin": self.origin or None,
            "conditions": finite(self.conditions),
            "path": str(self.path),
        }


def finite(value: Any) -> Any:
    """JSON has no NaN, though files may: null."""
    match value:
        case float():
            return value if math.isfinite(value) else None
        case list():
            return [finite(v) for v in value]
        case dict():
            return {k: finite(v) for k, v in value.items()}
        case _:
            return value


def row_of(folder: Path, about: Mapping[str, Any]) -> Row:
    """The row of a manifest whose named keys are of the kind they should be; whatever else is in it may be anything,
    and what of it cannot be meant stands in `problem`."""
    wrong = [*misfits(about), *misfits_of_ours(about)]
    about = usable(about) if wrong else about
    gear, campaign, conditions = about.get("gear"), about.get("campaign"), about.get("conditions")
    rows = about.get("rows")
    return Row(
        path=folder,
        uid=text(about.get("uid")),
        started_utc=text(about.get("started_utc")),
        procedure=text(about.get("label") or about.get("procedure")),
        gear=text(gear.get("serial")) if isinstance(gear, dict) else "",
        status=text(about.get("status")),
        verdict=text(about.get("verdict")),
        reason=text(about.get("exit_reason")),
        duration=number(about.get("duration")),
        rows=rows if isinstance(rows, int) and not isinstance(rows, bool) else None,
        backend=text(about.get("backend")),
        operator=text(about.get("operator")),
        campaign=text(campaign.get("uid")) if isinstance(campaign, dict) else "",
        conditions=conditions if isinstance(conditions, dict) else {},
        problem=text(" ".join([*(f"{why}." for why in of_no_use(folder, about)), *notes(wrong)])),
        digest=digest_of(about),
    )


def text(value: object) -> str:
    """A word of the manifest; a number is one too (a serial), anything else is as good as nothing said."""
    try:
        said = str(value) if isinstance(value, str | int | float) else ""
    except ValueError:  # an integer of more than 4300 digits
        return ""
    if said.isprintable():
        return said
    return "".join(c if c.isprintable() else "\ufffd" for c in said)  # no terminal, page or figure may be steered by it


def number(value: object) -> float | None:
    """A finite number, or None."""
    found = numbers.number(value)
    return None if math.isnan(found) else found


def moment(said: str) -> datetime | None:
    """ISO 8601 as UTC, a time without a zone taken as UTC; None when it is no such thing."""
    try:
        found = datetime.fromisoformat(said)
        return found.replace(tzinfo=UTC) if found.tzinfo is None else found.astimezone(UTC)
    except (ValueError, OverflowError):  # the years 1 and 9999 have zones beyond them
        return None
