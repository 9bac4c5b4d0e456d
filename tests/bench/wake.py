"""How late a loop wakes: hdrig's, and a C loop's, and the load they are put under."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import final

from rig.live.view.viewer import Viewer
from rig.procedures.standstill import Standstill
from rig.runfile.run import Run
from rig.session.done import Watch, nobody
from rig.session.observer import Begun, Observer
from tests.bench.built import Unavailable, built
from tests.bench.twin import run

HOGS = 2  # one busy neighbour a core


@dataclass(frozen=True)
class Wake:
    """µs, µs, and the share of cycles missed."""

    p50: float
    p99: float
    missed: float


@final
class Shown(Observer):
    """Has every run shown."""

    def __init__(self, viewer: Viewer) -> None:
        self._viewer = viewer

    def begun(self, run: Begun) -> Watch:
        self._viewer.follow(run.folder)
        return nobody


def ours(rate: float, seconds: float, looking_on: Observer | None = None) -> Wake:
    """A run of the twin on the wall clock, recorder and its syncs included."""
    with tempfile.TemporaryDirectory() as root:
        done = run(Standstill(seconds), Path(root), "wall", rate, looking_on=looking_on or Observer())
        said = Run.open(done.folder).timing
    missed = int(said["missed_cycles"])
    share = missed / (int(said["ticks"]) + missed)
    return Wake(1e6 * float(said["lateness_p50"]), 1e6 * float(said["lateness_p99"]), share)


def floor(rate: float, seconds: float) -> Wake:
    """The C loop. Raises Unavailable."""
    program = built("clock", kind=())
    done = subprocess.run([str(program), f"{rate:.0f}", f"{seconds:g}"], capture_output=True, text=True, check=True)
    if done.stderr:
        raise Unavailable(done.stderr.strip())
    return Wake(*(float(x) for x in done.stdout.split()))


@final
class Loaded:
    """Busy neighbours and a live view for as long as it is open; a context manager."""

    def __enter__(self) -> Shown:
        self._opened = ExitStack()
        for _ in range(HOGS):
            hog = subprocess.Popen([sys.executable, "-c", "while True: pass"])
            self._opened.callback(hog.wait)
            self._opened.callback(hog.kill)
        return Shown(self._opened.enter_context(Viewer("web")))

    def __exit__(self, *error: object) -> None:
        self._opened.close()
