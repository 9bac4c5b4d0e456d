"""A rig of a few lines: a rigid motor and load that can be told to misbehave. For tests of loop, guard and stops."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from rig.control.filter import SpeedFilter
from rig.core.clock import Clock
from rig.core.devices import AngleReading, Drive, DriveReading, Encoder, Identity, TorqueReading, TorqueSensor
from rig.core.drivetrain import Drivetrain
from rig.core.errors import NotReady
from rig.core.gains import Gains
from rig.core.procedure import Setting
from rig.core.sample import Mode, Sample, Setpoint
from rig.guard import Limits
from rig.instruments import Instruments

GAINS = Gains(Kp=3.0, Ki=30.0, Kd=0.12, integrator_limit=1.5, torque_limit=5.0, feedforward=0.0033)
DRIVETRAIN = Drivetrain(J_m=1.1e-3, J_l=1.28e-4, B=3.3e-3, tau_c=0.32, omega_n=158.0, zeta=0.04, ratio=50.0)
SETTING = Setting(period=0.001, ratio=50.0, control=GAINS, drivetrain=DRIVETRAIN)
LIMITS = Limits(
    speed=62.8,
    torque=5.0,
    shaft_torque=45.0,
    travel=377.0,
    following=0.17,
    following_time=0.1,
    twist=0.0087,
    stale=0.005,
)


class FakeClock(Clock):
    """Virtual time; `late` maps a tick to extra seconds it wakes late, `at` one to what happens at it."""

    def __init__(self) -> None:
        self.t = 0.0
        self.tick = 0
        self.late: dict[int, float] = {}
        self.at: dict[int, Callable[[], None]] = {}
        self.world: FakeWorld | None = None

    def now(self) -> float:
        return self.t

    def wait_until(self, t: float) -> float:
        self.tick += 1
        self.at.get(self.tick, lambda: None)()
        target = max(t, self.t) + self.late.get(self.tick, 0.0)
        if self.world is not None:
            self.world.advance(target - self.t)
        self.t = target
        return target

    def relax(self) -> bool:
        return True


@dataclass
class FakeWorld:
    """J·ω̇ = τ − drag; the load follows exactly."""

    clock: FakeClock = field(default_factory=FakeClock)
    inertia: float = 1.2e-3
    drag: float = 0.3
    theta: float = 10.0
    omega: float = 0.0
    tau: float = 0.0
    fault: str = ""
    silent_load: bool = False
    load_offset: float = 0.0
    load_sign: float = 1.0
    motor_sign: float = 1.0
    tau_l: float = 0.0
    confirms: bool = True
    history: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.clock.world = self

    def advance(self, dt: float) -> None:
        for _ in range(max(1, round(dt / 1e-3))):
            step = dt / max(1, round(dt / 1e-3))
            drive = self.tau - math.copysign(self.drag, self.omega) if self.omega else self.tau
            if self.omega == 0.0 and abs(self.tau) <= self.drag:
                continue
            before = self.omega
            self.omega += drive / self.inertia * step
            if before * self.omega < 0 and abs(self.tau) <= self.drag:
                self.omega = 0.0
            self.theta += self.omega * step


class FakeDrive(Drive):
    name = "drive"

    def __init__(self, world: FakeWorld) -> None:
        self.world, self.enabled = world, False

    def connect(self) -> Identity:
        return Identity("fake drive")

    def close(self) -> None:
        self.world.history.append("close")

    def enable(self, mode: Mode = Mode.TORQUE) -> None:
        if self.world.fault:
            raise NotReady(f"the drive refuses to enable: {self.world.fault}")
        self.enabled = True
        self.world.history.append("enable")

    def read(self) -> DriveReading:
        w = self.world
        return DriveReading(w.clock.t, w.motor_sign * w.theta, 0, w.tau, 0, w.fault)

    def write(self, setpoint: Setpoint) -> float:
        self.world.tau = setpoint[0] if self.enabled else 0.0
        return self.world.tau

    def halt(self) -> bool:
        self.world.tau, self.enabled = 0.0, False
        self.world.history.append("halt")
        return self.world.confirms

    def reset_fault(self) -> None:
        self.world.fault = ""


class FakeEncoder(Encoder):
    name = "load_encoder"

    def __init__(self, world: FakeWorld) -> None:
        self.world, self.last = world, AngleReading(0.0, 0.0, 0)

    def connect(self) -> Identity:
        return Identity("fake encoder")

    def close(self) -> None:
        pass

    def read(self) -> AngleReading:
        w = self.world
        if not w.silent_load:
            self.last = AngleReading(w.clock.t, w.load_sign * w.theta / 50.0 + w.load_offset, 0)
        return self.last


class FakeTorque(TorqueSensor):
    name = "torque_sensor"

    def __init__(self, world: FakeWorld) -> None:
        self.world = world

    def connect(self) -> Identity:
        return Identity("fake torque sensor")

    def close(self) -> None:
        pass

    def read(self) -> TorqueReading:
        return TorqueReading(self.world.clock.t, self.world.tau_l)


class ListSink:
    """Rows in a list; can be told to fail."""

    def __init__(self) -> None:
        self.rows: list[tuple[Sample, float, float, float]] = []
        self.error: Exception | None = None

    def put(self, sample: Sample, tau_ask: float, tau_applied: float, theta_ref: float) -> None:
        self.rows.append((sample, tau_ask, tau_applied, theta_ref))

    def check(self) -> None:
        if self.error is not None:
            raise self.error


def instruments(world: FakeWorld) -> Instruments:
    """All three devices on one fake world."""
    return Instruments(FakeDrive(world), FakeEncoder(world), FakeTorque(world), world.clock, SpeedFilter(0.008))
