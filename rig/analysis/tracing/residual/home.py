"""A coordinate that a rest lives in, and which of several is said."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from rig.analysis.tracing.residual.readings import Reading
from rig.analysis.tracing.thresholds import PLAIN_ENOUGH

SIMPLE: Final[Sequence[str]] = (
    "direction",
    "time_periodic",
    "motor_angle",
    "load_angle",
    "speed",
    "load",
    "memory",
    "temperature",
    "time",
)
"""Plainest first."""


@dataclass(frozen=True)
class Home:
    """A coordinate the rest lives in: the share of the excess it predicts in rows it was not fitted to."""

    coordinate: str
    channel: str
    share: float
    order: float | None = None  # cycles per turn
    frequency_hz: float | None = None
    read: Reading | None = None  # how it was read; none for a line
    own_zeros: bool = True  # whether every run had a zero of its own beside it
    late: bool = False  # said only where no plainer one does nearly as well
    first: bool = False  # said before all others that do no more than nearly as well
    said: str = ""  # what it is called, where that is more than its coordinate


def plainest(found: Sequence[Home]) -> list[Home]:
    """The best first, and before it simpler ones that do nearly as well; of those that are said late the best. A wave
    that all runs have in common and that tells more than any memory comes before that: how far something is behind its
    past tells when in which run a row is, and by that whatever goes slowly."""
    best = max(h.share for h in found)
    remembered = max((h.share for h in found if h.coordinate == "memory"), default=0.0)

    def rank(h: Home) -> tuple[bool, bool, bool, int, bool, float]:
        common = h.late and h.coordinate == "time_periodic" and h.share > remembered
        late = h.late and not common
        simple = len(SIMPLE) if late else SIMPLE.index("memory" if common else h.coordinate)
        return h.share < PLAIN_ENOUGH * best, not h.first, late, simple, not common, -h.share

    return sorted(found, key=rank)


WHERE_IT_TURNS_BACK: Final = Home("memory", "R", 1.0)
"""What stands only where the motor turns back remembers the way since then."""
