"""Runs of the twin for the rows that need one."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path

from rig.bench import ClockName, read
from rig.core.procedure import Procedure
from rig.process.interrupts import Interrupts
from rig.session import Done, Session
from rig.session.done import Watch, nobody
from rig.session.observer import Observer


def run(
    procedure: Procedure,
    root: Path,
    clock: ClockName = "virtual",
    rate: float = 1000.0,
    watch: Watch = nobody,
    looking_on: Observer | None = None,
) -> Done:
    """One run of the twin at `rate` Hz, recorded into a folder of its own in `root`."""
    bench = read("twin", [f"loop.rate={rate}"])
    quiet, observer = contextlib.redirect_stderr(io.StringIO()), looking_on or Observer()
    with quiet, Session(bench, clock, root, Interrupts(), observer=observer) as session:
        return session.run(procedure, watch)
