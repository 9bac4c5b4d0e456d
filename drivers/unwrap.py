"""Counters that wrap: raw readings to counts that go on, and what is no motion at all."""

from __future__ import annotations

from typing import Self

from drivers.wiring import Place
from rig.core.units import TURN

LATE = 50.0  # times the fastest motion between two readings: a step beyond is no motion


class Unwrapped:
    """Counts from a counter of `modulus` values. `most` is the largest step between two readings that is motion."""

    def __init__(self, modulus: int, most: int) -> None:
        self.modulus = modulus
        self.most = min(most, modulus // 2)
        self.counts: int | None = None
        self._raw = 0

    @classmethod
    def of(cls, place: Place, modulus: int) -> Self:
        """For the encoder at `place`, whose counter has `modulus` values."""
        fastest = place.speed_limit * place.period / (TURN / place.counts_per_turn)  # counts a tick
        return cls(modulus, max(int(LATE * fastest), 1))

    def step(self, raw: int) -> int:
        """Take a reading; how far it jumped beyond what is motion [counts], 0 when it did not.

        After a jump the counts go on from the new place: what was before and what comes after do not join.
        """
        if self.counts is None:
            self.counts, self._raw = raw, raw
            return 0
        moved = (raw - self._raw + self.modulus // 2) % self.modulus - self.modulus // 2
        self._raw = raw
        self.counts += moved
        return 0 if abs(moved) <= self.most else moved

    def forget(self) -> None:
        """The next reading starts anew."""
        self.counts = None
