"""Counters that wrap: raw readings to counts that go on, and what is no motion at all."""

from __future__ import annotations


class Unwrapped:
    """Counts from a counter of `modulus` values. `most` is the largest step between two readings that is motion."""

    def __init__(self, modulus: int, most: int) -> None:
        self.modulus = modulus
        self.most = min(most, modulus // 2)
        self.counts: int | None = None
        self._raw = 0

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
