"""Row 11: the live view."""

from __future__ import annotations

import time
from typing import ClassVar, final

import psutil

from rig.live.view.viewer import Viewer
from tests.bench.figure import AtMost, Figure, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds
from tests.bench.wake import Shown, Wake, ours

SETTLE = 2.0  # s for the viewer's start to be over


@final
class LiveView(Row):
    """13 channels at 1 kHz. No browser looks at the page: what a browser draws is the browser's machine's affair.

    Found and mended: what costs is the sending of a block, 0.3 ms for each of seven units, whatever rows it has (a
    thinning to 200 rows a second, from 500, saved nothing). Twenty blocks a second were sent, and ten pictures, where
    five were meant: with ten blocks and five pictures it is half (8.4 % and 4.1 % of a core in one session, at a load
    of 3 to 5). Of a curve's 30 s a block is 2 px or 3. A part of the 0.3 ms was what is the same for all units, made
    anew for each; and pyarrow imported pandas, for nothing: without both 0.78 of before.
    """

    number: ClassVar[int] = 11
    name: ClassVar[str] = "live view at 1 kHz, all channels"
    against: ClassVar[str] = "one core; the same run without it"

    def measure(self, rounds: Rounds) -> list[Figure]:
        seconds = rounds.size(10, 3)
        shares, with_view, without = [], [], []
        with Viewer("web") as viewer:
            looking_on, processes = Shown(viewer), [psutil.Process(viewer.pid), psutil.Process(viewer.viewer_pid)]
            time.sleep(SETTLE)
            for _ in range(min(rounds.count, 3)):
                before, began = _cpu(processes), time.monotonic()
                with_view.append(ours(1000, seconds, looking_on))
                shares.append(100.0 * (_cpu(processes) - before) / (time.monotonic() - began))
                without.append(ours(1000, seconds))
        return [
            Figure("CPU time of all its processes", shares, AtMost(5.0), "% of a core"),
            *_lateness(with_view, without),
        ]


def _cpu(processes: list[psutil.Process]) -> float:
    """CPU time so far [s]."""
    return sum(p.cpu_times().user + p.cpu_times().system for p in processes)


def _lateness(with_view: list[Wake], without: list[Wake]) -> list[Figure]:
    return [
        ratio(
            "p50 of the wake-up over that without it", [w.p50 for w in with_view], [w.p50 for w in without], AtMost(1.2)
        ),
        ratio(
            "p99 of the wake-up over that without it", [w.p99 for w in with_view], [w.p99 for w in without], AtMost(1.5)
        ),
    ]
