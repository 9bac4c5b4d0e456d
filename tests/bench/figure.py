"""One measured figure: its values round by round, what they were to reach, whether they do."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np


class Target(ABC):
    """What the median of a figure was to reach."""

    @abstractmethod
    def verdict(self, median: float) -> str:
        """ "met" or "not met"; "" where there is nothing to reach."""

    @abstractmethod
    def __str__(self) -> str: ...


@final
@dataclass(frozen=True)
class AtMost(Target):
    """No more than `limit`."""

    limit: float

    def verdict(self, median: float) -> str:
        return "met" if median <= self.limit else "not met"

    def __str__(self) -> str:
        return f"≤ {self.limit:g}"


@final
@dataclass(frozen=True)
class AtLeast(Target):
    """No less than `limit`."""

    limit: float

    def verdict(self, median: float) -> str:
        return "met" if median >= self.limit else "not met"

    def __str__(self) -> str:
        return f"≥ {self.limit:g}"


@final
@dataclass(frozen=True)
class Shown(Target):
    """No target: a figure that helps to read the others."""

    def verdict(self, median: float) -> str:
        return ""

    def __str__(self) -> str:
        return "–"


@dataclass(frozen=True)
class Figure:
    """`name`: what over what; `values`: one of each round; `unit`: × for a ratio."""

    name: str
    values: Sequence[float]
    target: Target
    unit: str = "×"
    missing: str = ""  # why it was not measured

    @property
    def median(self) -> float:
        """Of the rounds; NaN when not measured."""
        return float(np.median(self.values)) if len(self.values) else float("nan")

    def spread(self) -> tuple[float, float]:
        """10th and 90th percentile of the rounds."""
        low, high = np.percentile(self.values, [10.0, 90.0])
        return float(low), float(high)

    def verdict(self) -> str:
        """In the words of the table."""
        return f"not measured ({self.missing})" if self.missing else self.target.verdict(self.median)


def ratio(name: str, ours: Sequence[float], theirs: Sequence[float], target: Target) -> Figure:
    """Round by round, ours over theirs."""
    return Figure(name, [a / b for a, b in zip(ours, theirs, strict=True)], target)


def not_measured(name: str, target: Target, why: str) -> Figure:
    """A figure whose other side could not be had."""
    return Figure(name, (), target, missing=why)
