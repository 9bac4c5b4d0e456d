"""Loop statistics in constant memory: lateness of every tick, counted in microseconds."""

from __future__ import annotations

from typing import Any

CEILING = 100_000  # µs; later ticks share the last bin, the maximum is kept apart


class LoopTiming:
    """Lateness of ticks against their deadlines, and cycles missed. One `add` a tick, no allocation."""

    def __init__(self, period: float, virtual: bool) -> None:
        self.period = period  # s
        self.virtual = virtual
        self.ticks = 0
        self.missed = 0  # cycles skipped, never replayed
        self.late_events = 0  # times at least one cycle was skipped
        self.worst = 0.0  # s
        self.scheduling = ""  # what the operating system granted, in words
        self.offsets: dict[str, dict[str, float | int]] = {}  # latch times of channels, as their drivers tell
        self._bins = [0] * (CEILING + 1)

    def add(self, lateness: float) -> None:
        """One tick that woke `lateness` s after its deadline."""
        self.ticks += 1
        if lateness > self.worst:
            self.worst = lateness
        micro = int(lateness * 1e6)
        self._bins[micro if micro < CEILING else CEILING] += 1

    def skip(self, cycles: int) -> None:
        """`cycles` deadlines had passed before the tick began: they are counted and left out."""
        self.missed += cycles
        self.late_events += 1

    def quantile(self, share: float) -> float:
        """Lateness not exceeded by `share` of the ticks [s], to 1 µs."""
        wanted, seen = share * self.ticks, 0
        for micro, count in enumerate(self._bins):
            seen += count
            if count and seen >= wanted:
                return micro / 1e6
        return 0.0

    def summary(self) -> dict[str, Any]:
        """What `timing.json` holds; times in s."""
        return {
            "clock": "virtual" if self.virtual else "wall",
            "period": self.period,
            "ticks": self.ticks,
            "missed_cycles": self.missed,
            "late_events": self.late_events,
            "lateness_p50": self.quantile(0.50),
            "lateness_p99": self.quantile(0.99),
            "lateness_p999": self.quantile(0.999),
            "lateness_max": self.worst,
            "scheduling": self.scheduling,
            "latch_offsets": self.offsets,
            "latch_offsets_are": "s after theta_m, as the drivers tell; what they cannot know, only a skew run shows",
            "how": "a virtual clock is never late"
            if self.virtual
            else "wake-up against the absolute deadline on the monotonic clock, every tick, 1 µs bins",
        }
