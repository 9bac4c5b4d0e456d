"""What the station tells of itself: one picture, sent whole whenever it changes."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from rig.core.operator import Rigging

UNKNOWN_CHAIN = {
    "known": False,
    "closed": None,
    "text": "not known: no drive is connected that tells the state of its safe torque off",
}


@dataclass
class Status:
    """Everything a page shows but events and samples. Plain values throughout: it goes out as JSON."""

    bench: dict[str, Any] | None = None
    state: str = "disconnected"  # the supervisor's word
    job: str = ""  # what is being carried out, in words; "" when nothing is
    fault: str = ""
    unsure: str = ""  # the change by hand that was asked for and not shown
    chain: dict[str, Any] = field(default_factory=lambda: dict(UNKNOWN_CHAIN))
    checks: list[dict[str, Any]] = field(default_factory=list)
    proof: str | None = None
    tare: str | None = None
    rigging: dict[str, Any] = field(default_factory=lambda: Rigging().conditions())
    run: dict[str, Any] | None = None
    campaign: dict[str, Any] | None = None
    prompt: dict[str, Any] | None = None
    last_run: dict[str, Any] | None = None

    def picture(self) -> dict[str, Any]:
        """As the rules and the page know it."""
        return asdict(self)
