"""Whether the time of day written into runs can be believed."""

from __future__ import annotations

import ctypes
import time

from rig.bench import Bench
from rig.doctor.finding import Finding, Health

UNSYNCHRONISED = 5  # TIME_ERROR, what adjtimex returns then
EARLIEST = 1_700_000_000  # s since 1970, November 2023: a clock behind that was never set


def check_clock(bench: Bench) -> list[Finding]:
    """Resolution of the monotonic clock, and whether the time of day is kept by anything."""
    resolution = time.clock_getres(time.CLOCK_MONOTONIC)
    buffer = ctypes.create_string_buffer(512)  # struct timex, read only
    state = ctypes.CDLL(None).adjtimex(buffer)
    told = f"monotonic clock in steps of {resolution * 1e9:g} ns"
    if time.time() < EARLIEST:
        return [Finding("clock", Health.BAD, f"{told}; the time of day is {time.ctime()}, it was never set")]
    if state == UNSYNCHRONISED:
        return [Finding("clock", Health.DOUBTFUL, f"{told}; the time of day is not synchronised (no NTP)")]
    return [Finding("clock", Health.GOOD, f"{told}; the time of day is synchronised")]
