"""The slow run on the twin for one seed, in memory, and how far each Fourier coefficient lies from the plant's."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.analysis import analyse
from rig.bench import Bench, read
from rig.core.channels import CHANNELS
from rig.core.sample import Sample
from rig.guard import Guard
from rig.loop import Loop
from rig.procedures.kinematic_error import KinematicError
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from sim.world import World

Array = npt.NDArray[np.float64]
ARCSEC = math.radians(1 / 3600)


class ArraySink:
    """All rows in one array: what the recorder would have written."""

    def __init__(self, rows: int) -> None:
        self.rows = np.empty((rows, len(CHANNELS)))
        self.n = 0

    def put(self, s: Sample, tau_ask: float, tau_applied: float, theta_ref: float) -> None:
        self.rows[self.n] = (*s[:6], tau_ask, tau_applied, theta_ref, *s[6:10])
        self.n += 1

    def check(self) -> None:
        pass


@dataclass
class Memory:
    """A run that was never written."""

    rows: Array
    manifest: dict[str, Any]
    name: str = "in memory"
    procedure: str = "kinematic_error"
    ratio: float = 50.0
    conditions: dict[str, Any] = field(default_factory=dict)
    misfits: tuple[str, ...] = ()

    @property
    def declared(self) -> dict[str, Any]:
        return dict(self.manifest["declared"])

    def column(self, name: str) -> Array | None:
        index = [c.name for c in CHANNELS].index(name) if self.has(name) else None
        return None if index is None else self.rows[:, index]

    def has(self, name: str) -> bool:
        return name in {c.name for c in CHANNELS}


def slow_run(seed: int, **parameters: float) -> tuple[Memory, World, Bench]:
    """The procedure through the real loop, guard and devices, rows kept in memory."""
    bench = read("twin", [f"twin.seed={seed}"])
    rig, supervisor, procedure = bench.open("virtual"), Supervisor(), KinematicError(**parameters)
    setting = bench.setting(lambda text: None)
    envelope = procedure.envelope(setting)
    sink = ArraySink(int(envelope.duration / setting.period) + 10)
    rig.connect()
    supervisor.act(Act.CONNECT)
    supervisor.act(Act.CHECK)
    guard, timing = Guard(bench.limits, envelope, setting.ratio), LoopTiming(setting.period, virtual=True)
    ending = Loop(rig, supervisor, guard, sink, Interrupts(), timing).run(procedure, setting)
    assert ending.status == "completed", ending
    world = rig.clock
    assert isinstance(world, World)
    manifest = {**bench.manifest(), "conditions": procedure.conditions(), "status": "completed"}
    memory = Memory(sink.rows[: sink.n], manifest, conditions=procedure.conditions())
    drive: Any = rig.drive
    # a count stands for the middle of its step: true angle = zero + half a step + counts·step, on average
    memory.manifest["motor_zero"] = drive.encoder.zero + drive.encoder.step / 2
    return memory, world, bench


def pulls(seed: int) -> list[tuple[int, str, float, float]]:
    """(order, "a" or "b", true coefficient [arcsec], error over the half width of its 95 % interval), all orders."""
    run, world, _ = slow_run(seed)
    gear, zero = world.parameters.gear, run.manifest["motor_zero"]
    amplitude, phase = gear.kinematic_error.amplitude / ARCSEC, gear.kinematic_error.phase
    found = []
    for row in analyse(run).tables["coefficients"]:
        n = int(row["order"])
        shifted = phase[n - 1] - n * zero  # the encoder counts from power-up: the profile is read from there
        for part, true in (("a", amplitude[n - 1] * math.cos(shifted)), ("b", amplitude[n - 1] * math.sin(shifted))):
            half = float(row[f"{part}_hi"]) - float(row[f"{part}_lo"]) if f"{part}_hi" in row else 0.0
            half = half / 2 or 1.96 * float(row[f"u_{part}"])
            found.append((n, part, true, (float(row[f"{part}_arcsec"]) - true) / half))
    return found
