"""Row 4: a slow run on the twin, as a user runs it, and the plant in it."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import ClassVar, final

import numpy as np

from rig.procedures.kinematic_error import KinematicError
from tests.bench.figure import AtLeast, AtMost, Figure, Shown, ratio
from tests.bench.row import Row
from tests.bench.slow_run import SlowRun
from tests.bench.turns import Rounds, cpu, take_turns
from tests.bench.twin import run

EQUAL = 4  # steps of the floor a tick: its θ̃ is then 3e-9 rad RMS off, ours 3e-10; with 8 it is 6e-10
TRUTH = 64  # steps of the floor a tick for what both are compared with


@final
class Plant(Row):
    """The C floor takes one method for the whole run; ours looks for the instant at which a side stops or breaks away.

    Found: at one step a tick, the same recurrence for Eq. 8 and no events, C is a third faster and 250 times less
    accurate (6e-8 rad RMS, from the drive's lag and the reversals); with a table for Eq. 8 four times faster. At equal
    accuracy a table in C gains nothing worth having. In a run the plant is a tenth of a tick: a table in the kernel
    would be felt by nobody, and every other effect would have to know of it.

    Found and mended in the run: operations on enums and an interrupt counter worked out anew each tick (a sixth of it),
    and a recorder that imported pandas through pyarrow before its first row (two thirds of its start). What is left is
    the interpreter, 40 % of all samples in its inner loop and nothing else above 3 %: each of the devices, guard,
    reference and ring is some hundred bytecodes. No part of it can be left out without leaving hardware's code.

    Looked for again and left (2026-11-21, load 5): numba's dispatcher looks at the types of eight arguments for 0.2 µs
    of the 1.0 µs of a call, 2.5 % of a tick; latch offsets 3.5 %, loop timing 2 %, the interrupt counter 1 to 2 %. All
    of them together are a tenth, a quarter is missing. In the kernel, odd and even orders of Eq. 8 as two recurrences
    took 1.04 of its time; products and sums contracted, as C has them, 0.91 (1.53 of C after 1.68), and the same seed
    would then give other last digits on another processor.
    """

    number: ClassVar[int] = 4
    name: ClassVar[str] = "400 s slow run on the twin, virtual clock, control and recording included"
    against: ClassVar[str] = "C RK4 of the same equations (plant and position loop alone)"

    def measure(self, rounds: Rounds) -> list[Figure]:
        slow = SlowRun.of(rounds.size(400, 110))
        equal = slow.by_floor("-DTABLE", sub=EQUAL)
        sides = {
            "ours": cpu(slow.by_kernel),
            "equal": cpu(equal),
            "one": cpu(slow.by_floor()),
            "table": cpu(slow.by_floor("-DTABLE")),
        }
        cost = take_turns(sides, rounds.count)
        truth = slow.by_floor(sub=TRUTH)()
        off = [float(np.sqrt(np.mean((side() - truth) ** 2))) for side in (slow.by_kernel, equal, slow.by_floor())]
        return [
            ratio(
                f"plant over C at no less accuracy (table, {EQUAL} steps a tick)",
                cost["ours"],
                cost["equal"],
                AtMost(1.3),
            ),
            ratio("plant over C, the same recurrence, one step a tick", cost["ours"], cost["one"], AtMost(1.3)),
            ratio("plant over C, table, one step a tick", cost["ours"], cost["table"], Shown()),
            Figure("error of θ̃, RMS, ours", off[:1], Shown(), "rad"),
            Figure(f"error of θ̃, RMS, C with {EQUAL} steps", off[1:2], Shown(), "rad"),
            Figure("error of θ̃, RMS, C with one step", off[2:], Shown(), "rad"),
            *self._whole(rounds),
        ]

    def _whole(self, rounds: Rounds) -> list[Figure]:
        """Real-time factor of the run itself, folder closed: rig seconds over what a person waits, over CPU seconds."""
        seconds, waited, used = rounds.size(400, 10), [], []
        procedure = KinematicError(frequency=0.01 * 400 / seconds, amplitude_deg=1440.0 * seconds / 400, cycles=4.0)
        with tempfile.TemporaryDirectory() as root:
            for _ in range(1 + min(rounds.count, 3)):
                wall, busy = time.perf_counter(), time.process_time()
                run(procedure, Path(root))
                waited.append(seconds / (time.perf_counter() - wall))
                used.append(seconds / (time.process_time() - busy))
        return [
            Figure("whole run: rig time over wall time", waited[1:], AtLeast(200.0)),
            Figure("whole run: rig time over CPU time of the loop's process", used[1:], Shown()),
        ]
