"""How late this machine wakes a sleeping loop: absolute deadlines at the asked rate, as cyclictest measures it."""

from __future__ import annotations

from rig.bench import Bench
from rig.core.clock import WallClock
from rig.doctor.finding import Finding, Health
from rig.process.realtime import RealTime
from rig.timing.ticks import LoopTiming

SECONDS = 3.0
P99_SHARE = 0.2  # of the period: PID and bus still fit into the rest
MISSED_SHARE = 0.001  # of the cycles: a kinematic-error run loses nothing by it


def check_latency(bench: Bench) -> list[Finding]:
    """Three seconds of the loop's own timer, with nothing to do in it."""
    timing = measure(1.0 / bench.file.loop.rate, SECONDS)
    p50, p99, worst = timing.quantile(0.5), timing.quantile(0.99), timing.worst
    missed = timing.missed / (timing.ticks + timing.missed)
    good = p99 <= P99_SHARE * timing.period and missed <= MISSED_SHARE
    told = (
        f"wake-ups at {1 / timing.period:g} Hz late by {p50 * 1e6:.0f} µs (median), {p99 * 1e6:.0f} µs (99 %), "
        f"{worst * 1e6:.0f} µs (most) in {timing.ticks} cycles, {100 * missed:.2f} % missed"
    )
    if good:
        return [Finding("timer latency", Health.GOOD, told)]
    expected = f"{P99_SHARE * timing.period * 1e6:.0f} µs at 99 % and {100 * MISSED_SHARE:g} % missed at most"
    return [
        Finding("timer latency", Health.DOUBTFUL, f"{told}; expected {expected}: other work, or a virtual machine?")
    ]


def measure(period: float, seconds: float) -> LoopTiming:
    """Lateness of a loop of `period` s that does nothing for `seconds` s, with what scheduling it is granted."""
    timing, clock = LoopTiming(period, virtual=False), WallClock()
    with RealTime():
        start, k = clock.now(), 0
        while k * period < seconds:
            k += 1
            lateness = clock.wait_until(start + k * period) - (start + k * period)
            timing.add(max(lateness, 0.0))
            if lateness > period:
                timing.skip(int(lateness / period))
                k += int(lateness / period)
    return timing
