"""Row 2: what one tick costs."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar, final

import numpy as np
import psutil

from rig.bench import read
from rig.core.clock import Clock
from rig.core.sample import Sample
from rig.interrupts import Interrupts
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.standstill import Standstill
from rig.session import Session
from tests.bench.figure import AtMost, Figure, Shown
from tests.bench.row import Row
from tests.bench.turns import Rounds
from tests.bench.twin import run

PERIOD = 1e-3  # s
FIRST = 500  # ticks left out: first touches of code and memory
LOOKS = 10  # looks at the memory of a run
EARLY = 3  # looks that are left out: tables of the run still fill


class Stopwatch(Clock):
    """A clock that notes how long the loop was busy between two waits [s of wall time]."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._woke = time.perf_counter()
        self.busy: list[float] = []
        self.now, self.relax = clock.now, clock.relax  # type: ignore[method-assign]

    def now(self) -> float:
        return self._clock.now()

    def relax(self) -> bool:
        return self._clock.relax()

    def wait_until(self, t: float) -> float:
        self.busy.append(time.perf_counter() - self._woke)
        woken = self._clock.wait_until(t)  # the twin's plant catches up in here: not part of the tick
        self._woke = time.perf_counter()
        return woken


@final
class Tick(Row):
    """Real time, FIFO, on the twin: the bytes of a bus are decoded in row 3. The plant moves while the loop sleeps.

    What other processes take from the tick counts: on a busy machine p99.9 is theirs.
    """

    number: ClassVar[int] = 2
    name: ClassVar[str] = "whole tick work at 1 kHz: read, guard, procedure, PID, command, publish"
    against: ClassVar[str] = "the period of 1 ms"

    def measure(self, rounds: Rounds) -> list[Figure]:
        found = [self._busy(rounds.size(4, 2)) for _ in range(rounds.count)]
        middle, late = ([100.0 * float(np.quantile(b, q)) / PERIOD for b in found] for q in (0.5, 0.999))
        return [
            Figure("p50 of a tick", middle, Shown(), "% of the period"),
            Figure("p99.9 of a tick", late, AtMost(5.0), "% of the period"),
            self._growth(rounds.size(3600, 60)),
        ]

    def _busy(self, seconds: float) -> list[float]:
        with tempfile.TemporaryDirectory() as root:
            with Session(read("twin"), "wall", Path(root), Interrupts()) as session:
                watch = Stopwatch(session.instruments.clock)
                session.instruments.clock = watch
                session.run(KinematicError(frequency=1.0 / seconds, amplitude_deg=14.4 * seconds, cycles=1.0))
            return watch.busy[FIRST:-1]

    def _growth(self, seconds: float) -> Figure:
        """Memory of the loop's process during a run, first to last look, of one hour of rig time."""
        seen: list[float] = []
        with tempfile.TemporaryDirectory() as root:
            run(Standstill(seconds), Path(root), watch=_looking(seen, round(seconds * 10 / LOOKS)))
        return Figure(f"memory gained in {seconds:g} s of rig time", [seen[-1] - seen[EARLY]], AtMost(1.0), "MiB")


def _looking(seen: list[float], every: int) -> Callable[[Sample], None]:
    """Called ten times a second of rig time; looks at this process's memory [MiB] at every `every`th call."""
    process, calls = psutil.Process(), 0

    def look(sample: Sample) -> None:
        nonlocal calls
        calls += 1
        if calls % every == 0:
            seen.append(process.memory_info().rss / 2**20)

    return look
