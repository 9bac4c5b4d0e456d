"""A command as a process of its own, and what it cost."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.bench.built import Unavailable


@dataclass(frozen=True)
class Cost:
    """`cpu` and `wall` in s. The most memory it had: `own_mib` of its own, `peak_mib` with the pages of files it had in
    view, which the machine takes back when it needs them; `all_mib` together with the processes it began, what they
    share counted once (Pss).
    """

    cpu: float
    wall: float
    own_mib: float
    peak_mib: float
    all_mib: float


LOOK = 0.02  # s between looks at a child's memory
SELDOM = 0.2  # s between those that count what is shared: the kernel goes through all pages for it
HDRIG = (sys.executable, "-m", "rig.cli")


def cost(command: Sequence[str], folder: Path | None = None, allowed: tuple[int, ...] = (0,)) -> Cost:
    """Run to the end, children it waited for included. Raises Unavailable when it ends with another code."""
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    began = time.perf_counter()
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(
            [*command],
            stdout=subprocess.DEVNULL,
            stderr=said,
            cwd=folder,
            env=environment | {"OPENBLAS_NUM_THREADS": "1"},
        )
        own = peak = family = 0.0
        again = began
        while not (ended := os.wait4(process.pid, os.WNOHANG))[0]:
            own, peak = max(own, _memory(process.pid, "RssAnon")), max(peak, _memory(process.pid, "VmHWM"))
            if time.perf_counter() > again:
                family, again = max(family, _family(process.pid)), time.perf_counter() + SELDOM
            time.sleep(LOOK)
        _, status, usage = ended
        process.returncode = os.waitstatus_to_exitcode(status)  # reaped here: Popen must not look for it again
        if process.returncode not in allowed:
            said.seek(0)
            last = (said.read().decode(errors="replace").strip().splitlines() or ["no word"])[-1]
            raise Unavailable(f"{' '.join(command[-3:])} ended with {process.returncode}: {last}")
    return Cost(usage.ru_utime + usage.ru_stime, time.perf_counter() - began, own, peak, family)


def _memory(pid: int, what: str, file: str = "status") -> float:
    """A figure of a process [MiB]; 0 when it has ended. Not `ru_maxrss`, which begins with what this process has: a
    child of a large bench would never show less.
    """
    try:
        with open(f"/proc/{pid}/{file}", encoding="ascii", errors="replace") as lines:
            return next((int(line.split()[1]) / 1024 for line in lines if line.startswith(what)), 0.0)
    except OSError:
        return 0.0


def _family(pid: int) -> float:
    """Memory of a process and of its children, what they share counted once [MiB]."""
    try:
        text = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    except OSError:
        text = ""
    return sum(_memory(process, "Pss:", "smaps_rollup") for process in (pid, *map(int, text.split())))
