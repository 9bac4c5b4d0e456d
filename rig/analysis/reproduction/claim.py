"""What the paper says, and what the data say to it. The ruling is computed from numbers with intervals, never given."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum


class Ruling(StrEnum):
    """OPEN: the runs for it are missing, or the interval reaches over the limit."""

    HOLDS = "holds"
    FAILS = "fails"
    OPEN = "open"


@dataclass(frozen=True)
class Number:
    """A value with its 95 % interval; NaN ends where none could be had."""

    value: float
    low: float
    high: float
    unit: str

    @classmethod
    def of(cls, value: float, half: float, unit: str) -> Number:
        """From half the width of the interval."""
        return cls(value, value - half, value + half, unit)

    @property
    def half(self) -> float:
        """Half the width of the interval."""
        return 0.5 * (self.high - self.low)

    def minus(self, other: Number) -> Number:
        """The difference of two that were found apart from each other: half widths in quadrature      [gum, 5.1]"""
        return Number.of(self.value - other.value, math.hypot(self.half, other.half), self.unit)

    def over(self, other: Number) -> Number:
        """The ratio of two that were found apart from each other: relative half widths in quadrature      [gum, 5.1]"""
        ratio = self.value / other.value if other.value else math.nan
        return Number.of(ratio, abs(ratio) * math.hypot(self.half / self.value, other.half / other.value), "1")


@dataclass(frozen=True)
class Claim:
    """`paper` says it, `rule` says how it is judged; `words` has a {} for every number, in order."""

    paper: str
    ruling: Ruling
    words: str
    numbers: tuple[Number, ...] = ()
    rule: str = ""


def at_most(number: Number, limit: float) -> Ruling:
    """HOLDS when the whole interval is at or below `limit`, FAILS when it is above, else OPEN      [gum, 6.3]"""
    if not (math.isfinite(number.low) and math.isfinite(number.high)):
        return Ruling.OPEN
    if number.high <= limit:
        return Ruling.HOLDS
    return Ruling.FAILS if number.low > limit else Ruling.OPEN


def at_least(number: Number, limit: float) -> Ruling:
    """HOLDS when the whole interval is at or above `limit`, FAILS when it is below, else OPEN      [gum, 6.3]"""
    return at_most(Number(-number.value, -number.high, -number.low, number.unit), -limit)


def positive(number: Number) -> Ruling:
    """HOLDS when the whole interval is above zero, FAILS when no part of it is, else OPEN."""
    if number.low == number.high == 0.0:
        return Ruling.FAILS
    return at_least(number, 0.0)


def covers(number: Number, value: float) -> Ruling:
    """HOLDS when `value` lies in the interval, FAILS when it does not; OPEN without an interval."""
    if not (math.isfinite(number.low) and math.isfinite(number.high)):
        return Ruling.OPEN
    return Ruling.HOLDS if number.low <= value <= number.high else Ruling.FAILS


def all_of(*rulings: Ruling) -> Ruling:
    """FAILS when one fails, HOLDS when all hold."""
    if Ruling.FAILS in rulings:
        return Ruling.FAILS
    return Ruling.OPEN if Ruling.OPEN in rulings or not rulings else Ruling.HOLDS


def missing(paper: str, what: str) -> Claim:
    """Nothing was measured that could tell."""
    return Claim(paper, Ruling.OPEN, what)
