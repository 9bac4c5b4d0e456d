"""Who is writing a run, and whether they still live. A pid alone says little: pids come round again."""

from __future__ import annotations

import contextlib
import fcntl
import os
import platform
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypedDict, cast

from rig.core.errors import NotReady


class Process(TypedDict):
    """A process, told apart from a later one of the same number."""

    pid: int
    started: int  # clock ticks since boot; 0 where the system does not say
    host: str


def started(pid: int) -> int:
    """When process `pid` started [clock ticks since boot]; 0 when there is none, or it is a zombie, or unknown."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0
    return 0 if fields[0] in "ZX" else int(fields[19])  # state is field 3 of proc(5), starttime field 22


def this_process() -> Process:
    """The caller."""
    return Process(pid=os.getpid(), started=started(os.getpid()), host=platform.node())


def lives(process: Process) -> bool:
    """True when `process` runs on this machine now. One of another host cannot be seen and counts as dead."""
    pid, since = process.get("pid", 0), process.get("started", 0)
    if not isinstance(pid, int) or not isinstance(since, int) or not 0 < pid < 2**31:
        return False  # what somebody else wrote
    if process.get("host") != platform.node():
        return False
    if since or Path("/proc/self/stat").exists():
        return since != 0 and started(pid) == since
    return _answers(pid)


def is_being_made(about: Mapping[str, Any]) -> bool:
    """True when the program that writes the run of this manifest, or closes it, lives."""
    process = about.get("process")
    return isinstance(process, dict) and lives(cast(Process, process))


def _answers(pid: int) -> bool:
    """Where there is no /proc: any process of that number."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


@contextlib.contextmanager
def sole_writer(folder: Path, patience: float = 0.0) -> Iterator[None]:
    """Hold `folder` for one writer; let go when the process dies, however.

    Raises NotReady when another holds it for longer than `patience` [s]: a killed process, seen dead, may still be
    letting go of its files. Raises OSError when the folder cannot be opened.
    """
    handle = os.open(folder, os.O_RDONLY)
    try:
        _hold(handle, folder, time.monotonic() + patience)
        yield
    finally:
        os.close(handle)


def _hold(handle: int, folder: Path, give_up: float) -> None:
    while True:
        try:
            return fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() >= give_up:
                raise NotReady(f"{folder} is being written by another process; wait for it to end") from None
            time.sleep(0.02)
