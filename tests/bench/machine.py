"""Where and when: machine, commit, load."""

from __future__ import annotations

import os
import platform
import subprocess
from datetime import UTC, datetime
from pathlib import Path


def load() -> float:
    """Load average of the last minute: processes that wanted to run."""
    return os.getloadavg()[0]


def head() -> str:
    """The sentence under the table's title."""
    when = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    machine = f"{processor()}, {os.cpu_count()} cores, {platform.system()} {platform.release()}"
    return f"{when}, commit {commit()}, {machine}, Python {platform.python_version()}"


def commit() -> str:
    """The commit measured, and whether anything tracked differs from it."""
    said = subprocess.run(
        ["git", "describe", "--always", "--dirty=, tree changed"], capture_output=True, text=True, check=False
    )
    return said.stdout.strip() or "unknown"


def processor() -> str:
    """Its model's name."""
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.machine()
