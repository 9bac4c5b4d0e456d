"""Room for runs."""

from __future__ import annotations

from pathlib import Path

from rig.bench import Bench
from rig.doctor.finding import Finding, Health
from rig.runfile.room import free_under, rows_bytes

LEAST_HOURS = 4.0  # of recording: an afternoon


def check_disk(bench: Bench, folder: Path | None = None) -> list[Finding]:
    """Free space where runs go (`folder`, else the working directory), in hours at the bench's rate."""
    try:
        free = free_under(folder or Path.cwd())
    except OSError as error:
        told = f"the working folder, where runs would go, is not there ({error.strerror}); start hdrig in one that is"
        if folder is not None:
            told = f"cannot see how much room {folder} has, where runs go: {error.strerror}"
        return [Finding("disk", Health.BAD, told)]
    return [judge(free, bench.file.loop.rate)]


def judge(free: int, rate: float) -> Finding:
    """`free` bytes at `rate` Hz."""
    per_hour = rows_bytes(rate * 3600)
    hours = free / per_hour
    told = f"{free / 1e9:.1f} GB free, {hours:.0f} h of recording at {rate:g} Hz ({per_hour / 1e9:.2f} GB/h)"
    if hours < 0.5:
        return Finding("disk", Health.BAD, f"{told}; expected {LEAST_HOURS:g} h")
    if hours < LEAST_HOURS:
        return Finding("disk", Health.DOUBTFUL, f"{told}; expected {LEAST_HOURS:g} h")
    return Finding("disk", Health.GOOD, told)
