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
from rig.core.clock import Clock, WallClock
from rig.core.sample import Sample
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.standstill import Standstill
from rig.process.interrupts import Interrupts
from rig.process.realtime import RealTime
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

    What the machine takes from the tick counts, so each round also has a loop that is woken alike and only counts, for
    as long as the median tick: its p99.9 is the machine's, cold caches and stolen time. Found: of ours the slowest are
    the twin's own, one tick in 4096 that draws the noise of its sensors, 60 µs warm; the watch every 100 ticks is none.
    Drawn 256 at a time p99.9 was twice as large: numpy is cold by then, and costs 80 µs however little it draws.
    """

    number: ClassVar[int] = 2
    name: ClassVar[str] = "whole tick work at 1 kHz: read, guard, procedure, PID, command, publish"
    against: ClassVar[str] = "the period of 1 ms"

    def measure(self, rounds: Rounds) -> list[Figure]:
        seconds, middle, late, machine = rounds.size(8, 2), list[float](), list[float](), list[float]()
        for _ in range(rounds.count):
            tick = self._busy(seconds)
            middle.append(_share(tick, 0.5))
            late.append(_share(tick, 0.999))
            machine.append(_share(_counting(seconds, float(np.median(tick))), 0.999))
        beyond = [ours - its for ours, its in zip(late, machine, strict=True)]
        return [
            Figure("p50 of a tick", middle, Shown(), "% of the period"),
            Figure("p99.9 of a tick", late, AtMost(5.0), "% of the period"),
            Figure("p99.9 of a loop beside it that only counts: the machine's", machine, Shown(), "% of the period"),
            Figure("p99.9 of a tick beyond the machine's", beyond, AtMost(5.0), "% of the period"),
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


def _share(busy: list[float], quantile: float) -> float:
    """A quantile of busy times [s], % of the period."""
    return 100.0 * float(np.quantile(busy, quantile)) / PERIOD


def _counting(seconds: float, busy: float) -> list[float]:
    """How long a loop under the same clock and scheduling was busy [s] that counts for `busy` s at each tick, and
    touches next to no memory.
    """
    times, watch = _times(busy), Stopwatch(WallClock())
    with RealTime():
        start = watch.now()
        for k in range(round(seconds / PERIOD)):
            watch.wait_until(start + k * PERIOD)
            _count(times)
    return watch.busy[FIRST:]


def _times(busy: float) -> int:
    """How often to count so that it takes `busy` s, by the fastest of many tries."""
    tries = 1000
    took = []
    for _ in range(200):
        began = time.perf_counter()
        _count(tries)
        took.append(time.perf_counter() - began)
    return max(round(tries * busy / min(took)), 1)


def _count(times: int) -> None:
    for _ in range(times):
        pass


def _looking(seen: list[float], every: int) -> Callable[[Sample], None]:
    """Called ten times a second of rig time; looks at this process's memory [MiB] at every `every`th call."""
    process, calls = psutil.Process(), 0

    def look(sample: Sample) -> None:
        nonlocal calls
        calls += 1
        if calls % every == 0:
            seen.append(process.memory_info().rss / 2**20)

    return look
