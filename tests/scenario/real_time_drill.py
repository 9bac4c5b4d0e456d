"""By hand: `python -m tests.scenario.real_time_drill [PHASE …]` strikes every fault of `hdrig drill` in real time.

Real drivers in this process, the twin in another, every byte between them. What `hdrig drill` times on virtual time is
counted here: runs that ended as they have to, energised drives half a second after a run, runs that only a stall of
the machine ended (told apart by what the program says of itself, and made again).
"""

from __future__ import annotations

import inspect
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

from rig.bench import read
from rig.core.clock import WallClock
from rig.core.errors import HdrigError
from rig.drill.cause import Cause, Expected
from rig.drill.causes import CAUSES
from rig.drill.drill import as_expected
from rig.drill.phase import PHASES, Phase
from rig.drill.rig import Rows
from rig.guard import Guard
from rig.loop import Loop
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from sim.wire.faults import fault_verbs
from sim.wire.verbs import plant_verbs
from tests.scenario.real_time import twin_at
from tests.scenario.test_over_the_wire import Twin

AFTERWARDS = 0.5  # s until the drive's own watchdog has acted
REBOOT = 0.5  # s, for nodes that a fault has left half way
TRIES = 5
GOOD, AWAY = "as it has to", "the machine was away"
OVER = "at rest before it was seen"  # a stop takes 30 ms, and old data are no fault before 40 ms


class WireRig:
    """What causes and phases of the drill ask of a rig, with the twin in another process and time that passes."""

    def __init__(self, twin: Twin) -> None:
        self.twin, self.interrupts, self.rows = twin, Interrupts(), Rows()
        self.bench = read(str(twin.bench("twin-canopen")))
        clock = WallClock()
        self.verbs = {name: self._verb(name, spoken) for name, spoken in spoken_verbs().items()}
        self.assembly = SimpleNamespace(agenda=SimpleNamespace(after=self._after))
        self.wire = SimpleNamespace(now=clock.now, wait_until=clock.wait_until, stall=stall)
        self.instruments = self.bench.wired(clock)
        self.supervisor = Supervisor()
        self.timers: list[threading.Timer] = []
        self.running = False

    def _verb(self, name: str, spoken: Callable[..., Any]) -> Callable[..., Any]:
        def ask(*args: Any, **options: Any) -> Any:
            return self.twin.ask(do=name, **inspect.signature(spoken).bind(*args, **options).arguments)

        return ask

    def _after(self, seconds: float, act: Callable[[], Any]) -> None:
        self.timers.append(threading.Timer(seconds, act))
        if self.running:
            self.timers[-1].start()

    def run(self, phase: Phase) -> str:
        """Status of the run and its reason; "refused" with that of the refusal."""
        setting = self.bench.setting(lambda text: None)
        guard = Guard(self.bench.limits, phase.procedure.envelope(setting), setting.ratio)
        timing = LoopTiming(setting.period, virtual=False)
        loop = Loop(self.instruments, self.supervisor, guard, self.rows, self.interrupts, timing)
        self.running = True
        for timer in list(self.timers):
            timer.start()
        try:
            ending = loop.run(phase.procedure, setting)
        except HdrigError as why:
            return f"refused: {why}"
        return f"{ending.status}: {ending.reason}"

    def close(self) -> None:
        """No fault strikes any more; the buses are let go."""
        for timer in self.timers:
            timer.cancel()
        self.instruments.close()


def spoken_verbs() -> dict[str, Callable[..., Any]]:
    """The command channel's verbs by name, for the names of their arguments."""
    nobody = MagicMock()  # nothing is done here
    return {**plant_verbs(nobody, nobody), **fault_verbs(nobody, nobody, {}, {})}


def stall(seconds: float) -> None:
    """This process gets no processor for so long."""
    me = os.getpid()
    subprocess.Popen(["sh", "-c", f"kill -STOP {me}; sleep {seconds}; kill -CONT {me}"])


def drilled(twin: Twin, cause: Cause, phase: Phase) -> tuple[str, str]:
    """A word for the count, and what was said."""
    twin.ask(do="heal")
    twin.ask(do="unlock")
    for device in ("drive", "encoder", "torque"):
        twin.ask(do="reboot", device=device)
    time.sleep(REBOOT)
    rig = WireRig(twin)
    try:
        rig.instruments.connect()
        rig.supervisor.act(Act.CONNECT)
        rig.supervisor.act(Act.CHECK)
        phase.arrange(rig, lambda: cause.strike(rig))  # type: ignore[arg-type]
        said = rig.run(phase)
        time.sleep(AFTERWARDS)
        status = twin.ask(do="status")
    except HdrigError as why:
        return AWAY, f"not even connected: {why}"
    finally:
        rig.close()
    if status["drive"] == "OPERATION_ENABLED":
        return "STILL ENERGISED", said
    return judged(cause, phase, said), said


def judged(cause: Cause, phase: Phase, said: str) -> str:
    """Whether the run ended as it has to."""
    if not as_expected(cause, phase, said.partition(":")[0]):
        return GOOD
    if cause.expected is Expected.TRIP:
        return OVER if said.startswith("stopped") else "FAULT LOST"
    return AWAY if "no new" in said else "ENDED FOR NOTHING"


def main(names: list[str]) -> None:
    """The phases named, or all of them; a line for what was not as it has to be, a count of each phase."""
    with tempfile.TemporaryDirectory(dir="/tmp") as folder, twin_at(Path(folder), 7200.0) as twin:
        for phase in [p for p in PHASES if not names or p.name in names]:
            counts: Counter[str] = Counter()
            for cause in CAUSES:
                for _ in range(TRIES):
                    word, said = drilled(twin, cause, phase)
                    if word != AWAY:
                        break
                counts[word] += 1
                print(f"{phase.name}, {cause.name}: {word}: {said}", flush=True)
            print(f"= {phase.name}: {sum(counts.values())} faults, {dict(counts)}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
