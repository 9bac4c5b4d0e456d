"""Room for runs."""

from __future__ import annotations

import shutil
from pathlib import Path

from rig.bench import Bench
from rig.core.channels import CHANNELS
from rig.doctor.finding import Finding, Health

LEAST_HOURS = 4.0  # of recording: an afternoon


def check_disk(bench: Bench) -> list[Finding]:
    """Free space where runs go (the working directory), in hours at the bench's rate."""
    try:
        free = shutil.disk_usage(Path.cwd()).free
    except OSError as error:
        told = f"the working folder, where runs would go, is not there ({error.strerror}); start hdrig in one that is"
        return [Finding("disk", Health.BAD, told)]
    return [judge(free, bench.file.loop.rate)]


def judge(free: int, rate: float) -> Finding:
    """`free` bytes at `rate` Hz; the journal stays beside the archive, which is no larger."""
    per_hour = 2 * 8 * len(CHANNELS) * rate * 3600
    hours = free / per_hour
    told = f"{free / 1e9:.1f} GB free, {hours:.0f} h of recording at {rate:g} Hz ({per_hour / 1e9:.2f} GB/h)"
    if hours < 0.5:
        return Finding("disk", Health.BAD, f"{told}; expected {LEAST_HOURS:g} h")
    if hours < LEAST_HOURS:
        return Finding("disk", Health.DOUBTFUL, f"{told}; expected {LEAST_HOURS:g} h")
    return Finding("disk", Health.GOOD, told)
