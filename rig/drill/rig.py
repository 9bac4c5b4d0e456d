"""The rig of a drill: real drivers, the twin's devices, one virtual time, and a record of every command sent."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar

from rig.bench import Bench, read, twin_parameters
from rig.core.can_libraries import can
from rig.core.procedure import Procedure
from rig.core.sample import Sample
from rig.guard import Guard
from rig.loop import Ending, Loop
from rig.procedures.kinematic_error import KinematicError
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from sim.wire.assembly import Assembly
from sim.wire.faults import fault_verbs
from sim.wire.inprocess import InProcessBus, VirtualWire
from sim.wire.motor import Rating
from sim.wire.reactor import Reactor
from sim.wire.verbs import plant_verbs

STALE = "limits.stale_s=0.005"  # as on a machine with real-time scheduling: virtual time has no stalls of its own


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


class DrillRig(ABC):
    """Connected, nothing energised. `verbs` are the faults, as on the twin's command channel; `sent` are the frames
    (t [s], identifier, data) the host has sent to the drive.
    """

    longest_row: ClassVar[float] = 1.5e-3  # s between two rows of a run without a gap

    def __init__(self, seed: int = 7) -> None:
        twin = read("twin").file
        self.assembly = Assembly(twin_parameters(twin), seed, Rating(twin.motor.torque_rated), 1e6)
        self.wire = VirtualWire(self.assembly)
        self.bench = self.read_bench()
        self.sent: list[tuple[float, int, bytes]] = []
        self.verbs: dict[str, Callable[..., Any]] = {
            **plant_verbs(self.assembly, Reactor(self.assembly.agenda)),
            **fault_verbs(self.assembly, Reactor(self.assembly.agenda), {}, {}),
        }
        self.instruments = self.bench.wired(self.wire, connect=self.connect)
        self.supervisor, self.interrupts, self.rows = Supervisor(), Interrupts(), Rows()
        self.instruments.connect()
        self.supervisor.act(Act.CONNECT)
        self.supervisor.act(Act.CHECK)

    @abstractmethod
    def read_bench(self) -> Bench:
        """The bench that is drilled; its devices have booted when this returns."""

    @abstractmethod
    def connect(self, **options: Any) -> Any:
        """In place of `can.Bus`."""

    @abstractmethod
    def torque_in(self, identifier: int, data: bytes) -> bool:
        """Whether this frame asks an energised drive for a torque other than zero."""

    @property
    @abstractmethod
    def energised(self) -> bool:
        """The power stage is on, as the drive itself knows."""

    def recorded(self, bus: InProcessBus) -> Recorded:
        """`bus` with what the host sends written down."""
        return Recorded(bus, self.sent, self.wire.now)

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
        """When the host asked for a torque, after `since` s."""
        return [t for t, identifier, data in self.sent if t > since and self.torque_in(identifier, data)]

    def close(self) -> None:
        """Let go of the buses."""
        self.instruments.close()
