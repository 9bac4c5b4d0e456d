"""What one check found."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Health(StrEnum):
    """How bad it is."""

    GOOD = "good"
    DOUBTFUL = "doubtful"  # works, with what the sentence says
    BAD = "bad"  # a run would fail, or its data be worthless


@dataclass(frozen=True)
class Finding:
    """One line of the doctor's report."""

    what: str
    health: Health
    sentence: str  # the number with its unit, and what was expected
    simulated: bool = False  # a device of a bench on which one says that it is the twin's
