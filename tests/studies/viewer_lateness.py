"""How late the loop is with the live view absent, there, slow, frozen, killed: python -m tests.studies.viewer_lateness.

The conditions take turns, round by round, so that what else the machine does falls on all of them. Each is a run of
the twin at 1 kHz on the wall clock. Figures are printed; what is asserted are counts: every tick has its row.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import statistics
import subprocess
import tempfile
import time
from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path

from rig.bench import read
from rig.core.errors import NotReady
from rig.live.view.viewer import Viewer
from rig.procedures.standstill import Standstill
from rig.process.interrupts import Interrupts
from rig.runfile.run import Run
from rig.session import Session
from rig.session.done import Watch, nobody
from rig.session.observer import Begun, Observer

STARTS = 4  # of a viewer: its three processes are niced, and a busy machine may leave them nothing for 25 s
SETTLE = 1.0  # s of the run before anything happens to the viewer


class Condition(ABC):
    """What becomes of the viewer during a run."""

    name: str

    @abstractmethod
    def open(self) -> Viewer | None:
        """The viewer, before the run."""

    def script(self, viewer: Viewer) -> str:
        """What a shell does to it once the run has begun."""
        return ":"


class Absent(Condition):
    name = "absent"

    def open(self) -> Viewer | None:
        return None


class There(Condition):
    name = "there"

    def open(self) -> Viewer | None:
        for _ in range(STARTS - 1):
            with contextlib.suppress(NotReady):
                return Viewer("web")
        return Viewer("web")


class Slow(There):
    name = "slow"

    def script(self, viewer: Viewer) -> str:
        stop, go = f"kill -STOP {viewer.viewer_pid}", f"kill -CONT {viewer.viewer_pid}"
        return f"while {stop}; do sleep 0.9; {go}; sleep 0.1; done 2>/dev/null"


class Frozen(There):
    name = "frozen"

    def script(self, viewer: Viewer) -> str:
        return f"kill -STOP {viewer.viewer_pid}"


class FrozenBridge(There):
    name = "bridge frozen"

    def script(self, viewer: Viewer) -> str:
        return f"kill -STOP {viewer.pid}"


class Killed(There):
    name = "killed"

    def script(self, viewer: Viewer) -> str:
        return f"kill -KILL {viewer.viewer_pid}"


CONDITIONS: tuple[Condition, ...] = (Absent(), There(), Slow(), Frozen(), FrozenBridge(), Killed())


@dataclass(frozen=True)
class Measured:
    """One run: lateness in µs, cycles missed, ticks, rows kept, s that closing the viewer took."""

    p50: float
    p99: float
    worst: float
    missed: int
    ticks: int
    rows: int
    closing: float


class Show(Observer):
    """Has the run shown, and the viewer disturbed once it has begun."""

    def __init__(self, condition: Condition, viewer: Viewer | None) -> None:
        self._condition, self._viewer = condition, viewer
        self.shell: subprocess.Popen[bytes] | None = None

    def begun(self, run: Begun) -> Watch:
        if self._viewer is not None:
            self._viewer.follow(run.folder)
            script = f"sleep {SETTLE}; {self._condition.script(self._viewer)}"
            self.shell = subprocess.Popen(["sh", "-c", script], process_group=0)
        return nobody


def measure(condition: Condition, seconds: float, root: Path) -> Measured:
    """One run of `seconds` under a condition."""
    viewer = condition.open()
    show = Show(condition, viewer)
    with Interrupts() as interrupts, Session(read("twin", []), "wall", root, interrupts, observer=show) as session:
        done = session.run(Standstill(duration=seconds))
    if show.shell is not None:
        show.shell.kill()
        show.shell.wait()
    began = time.monotonic()
    if viewer is not None:
        viewer.close()
    closing = time.monotonic() - began
    run = Run.open(done.folder)
    said = run.timing
    micro = [1e6 * float(said[key]) for key in ("lateness_p50", "lateness_p99", "lateness_max")]
    missed, ticks = int(said["missed_cycles"]), int(said["ticks"])
    return Measured(*micro, missed, ticks, run.rows, closing)


def main() -> None:
    """Rounds of all conditions, then the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--seconds", type=float, default=10.0)
    args = parser.parse_args()
    found: dict[str, list[Measured]] = {condition.name: [] for condition in CONDITIONS}
    with tempfile.TemporaryDirectory() as root:
        for k in range(args.rounds):
            for condition in CONDITIONS[k % len(CONDITIONS) :] + CONDITIONS[: k % len(CONDITIONS)]:
                found[condition.name].append(measure(condition, args.seconds, Path(root)))
    load = ", ".join(f"{load:.1f}" for load in os.getloadavg())
    print("\n".join([f"twin, 1 kHz, wall clock; load of the machine at the end {load} (1, 5, 15 min)", *table(found)]))
    for runs in found.values():
        assert all(run.rows == run.ticks for run in runs), "a tick without its row"


def table(found: dict[str, list[Measured]]) -> list[str]:
    """Median over the rounds, lowest and highest in brackets; counts as sums."""
    lines = [f"{'viewer':14s} {'p50 µs':>18s} {'p99 µs':>22s} {'worst µs':>9s} {'missed':>12s} {'closing s':>9s}"]
    for name, runs in found.items():
        ticks = sum(run.ticks for run in runs)
        lines.append(
            f"{name:14s} {_spread([run.p50 for run in runs]):>18s} {_spread([run.p99 for run in runs]):>22s} "
            f"{max(run.worst for run in runs):9.0f} {sum(run.missed for run in runs):5d}/{ticks:<6d} "
            f"{max(run.closing for run in runs):9.2f}"
        )
    return lines


def _spread(values: list[float]) -> str:
    return f"{statistics.median(values):.0f} ({min(values):.0f}–{max(values):.0f})"


if __name__ == "__main__":
    main()
