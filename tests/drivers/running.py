"""A run on wired instruments, without files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rig.control.setpoints import setpoints_of
from rig.core.procedure import Procedure
from rig.core.sample import Sample
from rig.guard import Guard
from rig.loop import Ending, Loop
from rig.procedures.kinematic_error import KinematicError
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from tests.fakes import ListSink

SHORT = KinematicError(amplitude_deg=90.0, frequency=0.16, cycles=0.5)  # 9.6 rpm


def run(
    w: Any,
    procedure: Procedure = SHORT,
    watch: Callable[[Sample], None] = lambda sample: None,
    interrupts: Interrupts | None = None,
    timing: LoopTiming | None = None,
) -> tuple[Ending, ListSink]:
    """`w` has `bench` and connected `instruments`."""
    sink, supervisor = ListSink(), Supervisor()
    supervisor.act(Act.CONNECT)
    supervisor.act(Act.CHECK)
    setting = w.bench.setting(lambda text: None)
    guard = Guard(w.bench.limits, procedure.envelope(setting), setting.ratio)
    timing = timing or LoopTiming(setting.period, virtual=True)
    setpoints = setpoints_of(w.bench.mode, setting)
    loop = Loop(w.instruments, supervisor, guard, sink, interrupts or Interrupts(), timing, watch, setpoints)
    return loop.run(procedure, setting), sink
