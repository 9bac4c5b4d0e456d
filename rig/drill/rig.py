"""The rig of a drill: real drivers, the twin's nodes, one virtual time, and a record of every command sent."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

import can

from rig.bench import Bench, read, twin_parameters
from rig.core.procedure import Procedure
from rig.core.sample import Sample
from rig.guard import Guard
from rig.interrupts import Interrupts
from rig.loop import Ending, Loop
from rig.procedures.kinematic_error import KinematicError
from rig.supervisor import Act, Supervisor
from rig.timing import LoopTiming
from sim.wire.assembly import Assembly
from sim.wire.faults import fault_verbs
from sim.wire.inprocess import InProcessBus, VirtualWire
from sim.wire.motor import Rating
from sim.wire.reactor import Reactor
from sim.wire.verbs import plant_verbs

BENCH = "twin-canopen"
STALE = "limits.stale_s=0.005"  # as on a machine with real-time scheduling: virtual time has no stalls of its own
COMMAND = 0x201  # RPDO 1 of the drive
MOTOR_CONSTANT = 0.5  # N·m/A, the twin's nameplate; nothing here depends on it
ENERGISED = 0x0F  # controlword: operation enabled


class Rows:
    """Rows of a run, kept in memory."""

    def __init__(self) -> None:
        self.rows: list[tuple[Sample, float, float]] = []

    def put(self, sample: Sample, tau_ask: float, tau_applied: float, theta_ref: float) -> None:
        """One row."""
        self.rows.append((sample, tau_ask, tau_applied))

    def check(self) -> None:
        """Memory does not fail."""


class Recorded:
    """python-can's bus with every frame the host sends written down."""

    def __init__(self, bus: InProcessBus, sent: list[tuple[float, int, bytes]], now: Callable[[], float]) -> None:
        self._bus, self._sent, self._now = bus, sent, now

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Note it, pass it on."""
        self._sent.append((self._now(), msg.arbitration_id, bytes(msg.data)))
        self._bus.send(msg, timeout)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._bus, name)


class DrillRig:
    """Connected, nothing energised. `verbs` are the faults, as on the twin's command channel."""

    def __init__(self, seed: int = 7) -> None:
        twin = read("twin").file
        self.assembly = Assembly(twin_parameters(twin), seed, Rating(twin.motor.torque_rated, MOTOR_CONSTANT), 1e6)
        self.wire = VirtualWire(self.assembly)
        self.wire.wait_until(0.1)  # s, the nodes have booted
        self.bench: Bench = read(BENCH, [STALE])
        self.sent: list[tuple[float, int, bytes]] = []  # (t, identifier, data) of every frame of the host
        self.instruments = self.bench.wired(self.wire, connect=self._connect)
        reactor = Reactor(self.assembly.agenda)
        self.verbs = {**plant_verbs(self.assembly, reactor), **fault_verbs(self.assembly, reactor, {}, {})}
        self.supervisor, self.interrupts, self.rows = Supervisor(), Interrupts(), Rows()
        self.instruments.connect()
        self.supervisor.act(Act.CONNECT)
        self.supervisor.act(Act.CHECK)

    def _connect(self, **options: Any) -> Recorded:
        return Recorded(self.wire.connect(**options), self.sent, self.wire.now)

    def run(self, procedure: Procedure | None = None) -> Ending:
        """A procedure to its end, whatever that is. Raises what the loop raises."""
        procedure = procedure or KinematicError()
        setting = self.bench.setting(lambda text: None)
        guard = Guard(self.bench.limits, procedure.envelope(setting), setting.ratio)
        timing = LoopTiming(setting.period, virtual=True)
        return Loop(self.instruments, self.supervisor, guard, self.rows, self.interrupts, timing).run(
            procedure, setting
        )

    def torque_commands(self, since: float) -> list[float]:
        """When the host sent a torque other than zero to an energised drive, after `since` s."""
        out = []
        for t, identifier, data in self.sent:
            if identifier == COMMAND and t > since:
                word, permille = struct.unpack("<Hh", data)
                if word == ENERGISED and permille:
                    out.append(t)
        return out

    def close(self) -> None:
        """Let go of the bus."""
        self.instruments.close()
