"""One bench: what its file declares, in SI, and the devices and clock made of it."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from rig.bench.devices import ROLES, device_class, place_of
from rig.bench.manifest import manifest_of
from rig.bench.twin import twin_parameters
from rig.config.bench_file import BenchFile
from rig.control.filter import SpeedFilter
from rig.core.clock import Clock, WallClock
from rig.core.devices import Device
from rig.core.drivetrain import Drivetrain
from rig.core.errors import UsageError
from rig.core.gains import Gains
from rig.core.procedure import Setting
from rig.core.sample import Mode
from rig.core.units import DEG, RPM
from rig.guard import Limits
from rig.instruments import Instruments
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear, sigma_of
from rig.model.linear import damping_ratio, natural_frequency
from rig.twin_hand import TwinHand

ClockName = Literal["virtual", "wall"]


@dataclass(frozen=True)
class Bench:
    """One bench file, read and resolved."""

    file: BenchFile
    text: str  # what goes into the run folder as bench.toml
    source: str

    @property
    def simulated(self) -> bool:
        """True when every device is the twin's. A mixture is refused when the bench is read."""
        return self.file.devices.drive.type.startswith("twin.")

    @property
    def by_person(self) -> bool:
        """Weights and pin are a person's to change; a twin has a hand of its own, also over a wire."""
        return not self.simulated and self.file.hand is None

    @property
    def twin_not_there(self) -> str:
        """How the twin this bench reaches over a wire is started, where its doors are not there; "" else."""
        if self.file.hand is None:
            return ""
        devices = (getattr(self.file.devices, role) for role in ROLES)
        ports = [Path(port) for one in devices if isinstance(port := getattr(one, "port", None), str)]
        if all(door.exists() for door in (Path(self.file.hand.control), *ports)):
            return ""
        serial = f" --serial {ports[0].parent}" if ports else ""
        return f"this bench reaches the twin over a wire: start `hdrig twin{serial}` in another terminal first"

    @property
    def gains(self) -> Gains:
        """Of the position loop."""
        c = self.file.control
        limit = min(self.file.limits.torque, self.file.motor.torque_limit)
        return Gains(c.Kp, c.Ki, c.Kd, c.integrator_limit, limit, c.feedforward)

    @property
    def limits(self) -> Limits:
        """What the guard holds every run to, SI."""
        lim, devices = self.file.limits, self.file.devices
        return Limits(
            speed=lim.speed_rpm * RPM,
            torque=lim.torque,
            shaft_torque=lim.shaft_torque if devices.torque_sensor else None,
            travel=lim.travel_turns * 2 * math.pi,
            following=lim.following_deg * DEG,
            following_time=lim.following_s,
            twist=lim.twist_deg * DEG if devices.load_encoder else None,
            stale=lim.stale_s,
        )

    @property
    def mode(self) -> Mode:
        """What the drive is given where a procedure has a reference; anything else is run in torques."""
        return Mode(self.file.control.mode)

    def setting(self, note: Callable[[str], None]) -> Setting:
        """What a procedure is told about the rig; `note` receives its remarks."""
        g = self.file.gear
        return Setting(1.0 / self.file.loop.rate, g.N, self.gains, self.drivetrain, note, g.K)

    @property
    def drivetrain(self) -> Drivetrain:
        """Declared inertias, damping and friction, seen at the motor, output free."""
        g, gear = self.file.gear, self.declared_gear
        return Drivetrain(
            J_m=g.J_m,
            J_l=g.J_l / g.N**2,
            B=gear.viscous,
            tau_c=g.tau_c,
            omega_n=natural_frequency(gear),
            zeta=damping_ratio(gear),
            ratio=g.N,
        )

    @property
    def declared_gear(self) -> Gear:
        """Without its kinematic error, which nobody declares."""
        g = self.file.gear
        return Gear(g.N, g.J_m, g.J_l, g.K, g.B_m, g.B_l, g.B_ml, g.B_sp, FourierSeries((), ()), sigma_of(g.output))

    def manifest(self) -> dict[str, Any]:
        """The bench's part of a run's manifest."""
        return manifest_of(self.file, self.simulated)

    def refuse_clock(self, clock: ClockName) -> None:
        """Raises UsageError for a clock that this bench cannot have."""
        if not self.simulated and clock == "virtual":
            raise UsageError(f"{self.source}: the virtual clock exists only on the twin; use --clock wall")

    def open(self, clock: ClockName) -> Instruments:
        """Make the devices and their clock; nothing is connected yet. Raises UsageError."""
        self.refuse_clock(clock)
        timer, world = self._clock(clock)
        if world is None:
            return self.wired(timer)
        speed = SpeedFilter(self.file.loop.speed_filter)
        made = {role: self._device(role, world) for role in ROLES}
        hand = importlib.import_module("sim.operator").TwinOperator(world)
        return Instruments(made["drive"], made["load_encoder"], made["torque_sensor"], timer, speed, hand)

    def _clock(self, clock: ClockName) -> tuple[Clock, Any]:
        if not self.simulated:
            return WallClock(), None
        world = importlib.import_module("sim.world").World(twin_parameters(self.file), self._twin_seed())
        return (world if clock == "virtual" else WallClock(world.advance_to)), world

    def _twin_seed(self) -> int:
        return self.file.twin.seed if self.file.twin else 0

    def _device(self, role: str, *plugged: Any) -> Any:
        make = self.device(role)
        return None if make is None else make(*plugged)

    def wired(self, timer: Clock, **connect: Callable[..., Any]) -> Instruments:
        """Real devices on buses and ports; `connect` opens a bus in place of python-can."""
        from drivers.wiring import Wiring

        speed = SpeedFilter(self.file.loop.speed_filter)
        wiring = Wiring(timer, {name: bus.model_dump() for name, bus in self.file.bus.items()}, **connect)
        made = {
            role: self._device(role, wiring, place_of(role, self.file, self.limits))
            for role in ROLES
            if self._has(role)
        }
        hand = TwinHand(self.file.hand.control) if self.file.hand else None
        return Instruments(
            made["drive"], made.get("load_encoder"), made.get("torque_sensor"), timer, speed, hand,
            latch=wiring.latch, lead=self.file.loop.latch_lead,
        )  # fmt: skip

    def traffic(self) -> dict[str, tuple[list[int], list[int]]]:
        """For each bus that is used: data bytes of the frames that answer a SYNC, and of the commands, one a tick."""
        out: dict[str, tuple[list[int], list[int]]] = {}
        for role in ROLES:
            section, made = getattr(self.file.devices, role), self.device(role)
            if section is not None and section.bus is not None:
                up, down = out.setdefault(section.bus, ([], []))
                up += getattr(made, "answers", ())
                down += getattr(made, "commands", ())
        return out

    def _has(self, role: str) -> bool:
        return getattr(self.file.devices, role) is not None

    def device(self, role: str) -> Callable[..., Device] | None:
        """The class that fills a role, or None where the bench has none. Raises UsageError when it cannot."""
        section = getattr(self.file.devices, role)
        if section is None:
            return None
        where = f"{self.source}: devices.{role}.type"
        made = device_class(section.type, where)
        if not (isinstance(made, type) and issubclass(made, ROLES[role])):
            raise UsageError(f"{where} = '{section.type}': that device is no {role.replace('_', ' ')}")
        return made
