"""What a selection answers: the verdict, the effects that were tried, the run that would tell more."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum


class Status(StrEnum):
    """The verdict's word."""

    EXPLAINED = "explained"
    NOTHING = "no_missing_effect"
    UNKNOWN = "unknown_effect"
    AMBIGUOUS = "ambiguous"


@dataclass(frozen=True)
class Verdict:
    """What is missing in the model."""

    status: Status
    effects: tuple[str, ...]
    rivals: tuple[str, ...]
    coordinate: str | None
    order: float | None  # cycles per turn of that coordinate
    frequency_hz: float | None
    sentence: str


@dataclass(frozen=True)
class Candidate:
    """One effect of the library, as scored."""

    effect: str
    evidence: float  # nats by which it beats having nothing more, after paying for its parameters
    why: str
    heldout_rms: dict[str, float] = field(default_factory=dict)  # by channel, with it in the model


@dataclass(frozen=True)
class NextRun:
    """The cheapest run that would decide, or that would say most of what is unknown."""

    procedure: str
    conditions: dict[str, float | bool | str]
    because: str
