"""The recorder's process: `python -m rig.recorder FOLDER RING`, started by `Recorder` and by nobody else.

It is as ordinary as a process can be, whatever the loop that started it is; a Ctrl-C or a service manager's stop, which
goes to every process of the program, does not reach it: it ends when the loop says so, or is dead.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import time
from pathlib import Path

from rig.core.errors import HdrigError
from rig.core.ring import Ring
from rig.recorder.service import POLL, Service
from rig.runfile import manifest
from rig.runfile.columns import schema_of
from rig.runfile.journal import JournalWriter, rows_in_journal
from rig.runfile.process import sole_writer, started


def main(folder: Path, ring_path: Path) -> int:
    """Record until told to end; the exit code is 0 when every row is on disk."""
    _be_ordinary()
    try:
        ring = Ring.attach(ring_path, writable=True)
    except HdrigError as error:  # the loop died at once, and its run was recovered before we looked
        print(error, file=sys.stderr)
        return 1
    try:
        with sole_writer(folder):
            _record(folder, ring)
    except OSError as error:
        where = error.filename or folder
        ring.tell_error(error.errno or 1, f"the recorder cannot write {where}: {error.strerror or error}")
        return 1
    except HdrigError as error:
        ring.tell_error(1, str(error))
        return 1
    return 0


def _be_ordinary() -> None:
    """Normal scheduling even when the loop that started us is real-time; deaf to signals meant for the whole group."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_IGN)
    with contextlib.suppress(OSError, AttributeError):  # AttributeError: no such call on this system
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        os.setpriority(os.PRIO_PROCESS, 0, max(0, os.getpriority(os.PRIO_PROCESS, 0)))


def _record(folder: Path, ring: Ring) -> None:
    about = manifest.as_written(folder)
    if about["status"] != "running":
        raise HdrigError(f"{folder} is {about['status']}: nothing more can be recorded into it")
    layout = schema_of(about)
    journal = JournalWriter(folder, layout, first=max(rows_in_journal(folder), ring.oldest))
    service = Service(ring, journal, time.monotonic())
    ring.tell_reader(os.getpid(), started(os.getpid()))
    orphan = _serve(ring, service)
    service.finish()
    if orphan and not ring.closed:
        _mark_interrupted(folder, ring, journal.rows)


def _serve(ring: Ring, service: Service) -> bool:
    """Step until the loop has put its last row. True when it died instead of saying so."""
    while True:
        orphan = os.getppid() != ring.producer_pid
        if orphan or ring.closed:
            return bool(orphan)
        service.step(time.monotonic())
        if not service.pressed:
            time.sleep(POLL)


def _mark_interrupted(folder: Path, ring: Ring, rows: int) -> None:
    """Say in the manifest what happened; the ring has nothing left that the journal lacks."""
    why = f"the program (process {ring.producer_pid}) died; its recorder kept all {rows} rows it had put"
    manifest.update(folder, status="interrupted", exit_reason=why, rows=rows, ring=None)
    ring.unlink()


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
