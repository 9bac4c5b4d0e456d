"""Row 3: a cycle over CAN."""

from __future__ import annotations

import struct
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import ClassVar, final

import can
import numpy as np

from rig.bench import BENCHES, Bench
from rig.config.bench_file import read_bench
from rig.core.clock import WallClock
from rig.core.sample import Torque
from rig.instruments import Instruments
from rig.process.realtime import RealTime
from tests.bench.child import HDRIG
from tests.bench.figure import AtMost, Figure, Shown, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds

PERIOD = 1e-3  # s
PATIENCE = 5e-3  # s until a cycle's answers are given up
SYNC, ANSWERS = 0x080, range(0x180, 0x580)  # identifiers      [cia301, 7.3.5]
COMMANDS = (0x200, 0x300, 0x400, 0x500)  # functions of what a host sends, among them


def is_answer(identifier: int) -> bool:
    """TPDOs: 180h, 280h, 380h, 480h and the node."""
    return identifier in ANSWERS and identifier & 0x80 != 0


@dataclass
class Raw:
    """As one writes it with python-can: SYNC, receive until all answered, unpack, the command back."""

    bus: can.BusABC
    answers: frozenset[int] = frozenset()
    command: can.Message | None = None
    values: dict[int, tuple[int, ...]] = field(default_factory=dict)

    def cycle(self) -> bool:
        """True when all answers came in time."""
        self._empty()
        self.bus.send(can.Message(arbitration_id=SYNC, is_extended_id=False))
        missing, until = set(self.answers), time.monotonic() + PATIENCE
        while missing:
            message = self.bus.recv(max(until - time.monotonic(), 0.0))
            if message is None:
                return False
            if message.arbitration_id in missing:
                missing.discard(message.arbitration_id)
                self.values[message.arbitration_id] = struct.unpack(f"<{len(message.data)}B", message.data)
        if self.command is not None:
            self.bus.send(self.command)
        return True

    def _empty(self) -> None:
        while (message := self.bus.recv(0.0)) is not None:
            if message.arbitration_id & 0x780 in COMMANDS:
                self.command = message  # the other host's: the same bytes are sent here

    def learn(self, cycle: Callable[[], bool]) -> None:
        """Which frames answer a SYNC, from one of the other host's cycles."""
        cycle()
        time.sleep(PATIENCE)
        heard = set()
        while (message := self.bus.recv(0.0)) is not None:
            heard.add(message.arbitration_id)
        self.answers = frozenset(i for i in heard if is_answer(i))


@dataclass
class Ours:
    """The drivers as the loop calls them, at once instead of at the tick: latch, read when all is there, write."""

    instruments: Instruments
    answers: frozenset[int] = frozenset()

    def cycle(self) -> bool:
        """True when all answers came in time."""
        assert self.instruments.latch is not None
        bus = self.instruments.drive.node.bus  # type: ignore[attr-defined]
        self.instruments.latch()
        missing = [(i, bus.frames[i].number) for i in self.answers if i in bus.frames]
        there = bus.wait(PATIENCE, lambda: all(bus.frames[i].number > n for i, n in missing))
        self.instruments.read(self.instruments.clock.now())
        self.instruments.write(Torque(0.0))
        return bool(there)


@contextmanager
def hosts() -> Iterator[tuple[Ours, Raw]]:
    """The twin as a process, both hosts on its bus, the drive enabled at zero torque."""
    with tempfile.TemporaryDirectory(dir="/tmp") as doors:
        command = [*HDRIG, "twin", "--bus", "can", "--control", "control"]
        twin = subprocess.Popen(command, cwd=doors, stdout=subprocess.PIPE, text=True)
        try:
            assert twin.stdout is not None
            next(line for line in twin.stdout if line == "ready\n")
            text = (BENCHES / "twin-canopen.toml").read_text(encoding="utf-8").replace("/tmp/hdrig-twin", doors)
            instruments = Bench(read_bench(text, "bench"), text, "bench").wired(WallClock())
            instruments.connect()
            try:
                with can.Bus(interface="hdrig-unix", channel=f"{doors}/can") as bus:
                    yield Ours(instruments), Raw(bus)
            finally:
                instruments.close()
        finally:
            twin.terminate()
            twin.wait()


@final
class CanCycle(Row):
    """Cycle by cycle in turn, both FIFO, on one bus of 1 Mbit/s whose frames take their time: half a millisecond.

    Ours checks lengths, states, heartbeats and time stamps besides; raw decodes bytes and looks at nothing.
    """

    number: ClassVar[int] = 3
    name: ClassVar[str] = "CAN cycle over the twin's bus: SYNC, TPDOs, command"
    against: ClassVar[str] = "raw python-can and struct on the same bus"

    def measure(self, rounds: Rounds) -> list[Figure]:
        cycles = rounds.size(2000, 300)
        with hosts() as (ours, raw):
            ours.instruments.start()
            ours.instruments.drive.enable()
            raw.learn(ours.cycle)
            ours.answers = raw.answers
            with RealTime():
                found = [turns(ours, raw, cycles) for _ in range(rounds.count)]
        middle = [[float(np.median(side[0])) for side in one] for one in found]
        points = [100.0 * (one[0][1] - one[1][1]) / cycles for one in found]
        return [
            ratio("p50 of the cycle over raw", [m[0] for m in middle], [m[1] for m in middle], AtMost(1.3)),
            Figure("cycles without all answers within the period, beyond raw's", points, AtMost(0.1), "points"),
            Figure("frames that answer a SYNC", [len(raw.answers)], Shown(), ""),
        ]


def turns(ours: Ours, raw: Raw, cycles: int) -> list[tuple[list[float], int]]:
    """For each side: durations [s] of its cycles, and how many missed the period."""
    out: list[tuple[list[float], int]] = []
    sides = (ours.cycle, raw.cycle)
    took: list[list[float]] = [[], []]
    missed, start = [0, 0], time.monotonic()
    for k in range(2 * cycles):
        time.sleep(max(start + k * PERIOD - time.monotonic(), 0.0))
        began = time.monotonic()
        whole = sides[k % 2]()
        took[k % 2].append(time.monotonic() - began)
        missed[k % 2] += not whole or took[k % 2][-1] > PERIOD
    out += [(took[side], missed[side]) for side in (0, 1)]
    return out
