"""A procedure run on the twin in this process, as a run to analyse, with what really happened beside it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rig.bench import Bench, read
from rig.core.procedure import Procedure
from rig.core.sample import Sample
from rig.guard import Guard
from rig.instruments import Instruments
from rig.loop import Ending, Loop
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from tests.analysis.synthetic import Array, MadeRun

COLUMNS = ("t", "theta_m", "theta_l", "omega_m", "tau_m", "tau_l")


@dataclass
class Rig:
    """One twin that several procedures are run on, one after the other: its encoders keep their zero."""

    overrides: tuple[str, ...] = ()
    bench: Bench = field(init=False)
    instruments: Instruments = field(init=False)

    def __post_init__(self) -> None:
        self.bench = read("twin", self.overrides)
        self.instruments = self.bench.open("virtual")
        self.instruments.connect()

    @property
    def world(self) -> Any:
        return self.instruments.drive.world  # type: ignore[attr-defined]

    def run(self, procedure: Procedure) -> Taken:
        """Run it to its end; raises what the loop raises."""
        sink, supervisor = _Sink(self.world), Supervisor()
        supervisor.act(Act.CONNECT)
        supervisor.act(Act.CHECK)
        setting = self.bench.setting(sink.notes.append)
        guard = Guard(self.bench.limits, procedure.envelope(setting), setting.ratio)
        loop = Loop(self.instruments, supervisor, guard, sink, Interrupts(), LoopTiming(setting.period, virtual=True))
        ending = loop.run(procedure, setting)
        manifest = self.bench.manifest()
        manifest |= {"procedure": procedure.name, "status": ending.status, "conditions": procedure.conditions()}
        return Taken(MadeRun(sink.columns(), manifest, procedure.title()), ending, np.array(sink.phi), sink.notes)


@dataclass(frozen=True)
class Taken:
    """A run, how it ended, and the true spring deflection φ [rad at the output] of every row."""

    run: MadeRun
    ending: Ending
    phi: Array
    notes: list[str]


class _Sink:
    """Rows in lists, with the truth beside them."""

    def __init__(self, world: Any) -> None:
        self.world = world
        self.samples: list[Sample] = []
        self.rest: list[tuple[float, float, float]] = []
        self.phi: list[float] = []
        self.notes: list[str] = []

    def put(self, sample: Sample, tau_ask: float, tau_applied: float, theta_ref: float) -> None:
        self.samples.append(sample)
        self.rest.append((tau_ask, tau_applied, theta_ref))
        self.phi.append(self.world.truth().phi)

    def check(self) -> None:
        pass

    def columns(self) -> dict[str, Array]:
        table = {name: np.array([getattr(s, name) for s in self.samples]) for name in COLUMNS}
        asked = np.array(self.rest)
        return table | {"tau_ask": asked[:, 0], "tau_applied": asked[:, 1], "theta_ref": asked[:, 2]}
