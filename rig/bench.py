"""From a bench file to a rig: devices, limits, gains, clock. Beside the first bench, the drill and the commands
`devices` and `twin` the only place that knows drivers/ and sim/.
"""

from __future__ import annotations

import importlib
import importlib.util
import math
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from rig.config.bench_file import BenchFile, read_bench
from rig.config.text_file import load_text
from rig.config.together import check_keys, check_together
from rig.control.filter import SpeedFilter
from rig.core.clock import Clock, WallClock
from rig.core.devices import Device, Drive, Encoder, TorqueSensor
from rig.core.drivetrain import Drivetrain
from rig.core.errors import UsageError
from rig.core.gains import Gains
from rig.core.nearest import nearest
from rig.core.procedure import Setting
from rig.core.sample import Mode
from rig.core.units import DEG, RPM
from rig.guard import Limits
from rig.instruments import Instruments
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear, sigma_of
from rig.model.linear import damping_ratio, natural_frequency
from rig.twin_hand import TwinHand

BENCHES = Path(__file__).parent / "benches"  # benches that ship with hdrig
ClockName = Literal["virtual", "wall"]
ROLES: dict[str, Any] = {"drive": Drive, "load_encoder": Encoder, "torque_sensor": TorqueSensor}


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
        f = self.file
        encoders = {"motor_counts_per_rev": f.motor.counts_per_turn}
        if f.load_encoder:
            encoders["load_counts_per_rev"] = f.load_encoder.counts_per_turn
        gear = {"ratio": f.gear.N, "output": f.gear.output, "serial": f.gear.serial}
        keys = ("J_m", "J_l", "K", "B_m", "B_ml", "B_l", "B_sp", "fourier_terms")
        declared = {key: getattr(f.gear, key) for key in keys}
        optional = {key: getattr(f.gear, key) for key in ("T_rated", "T1", "T2")} | f.path.model_dump()
        declared |= {key: value for key, value in optional.items() if value is not None}
        backend = "sim" if self.simulated else f.devices.drive.type.partition(".")[0]
        own = {"backend": backend, "bench": f.name, "gear": gear, "declared": declared, "encoders": encoders}
        return own | ({"latch_skew": skew} if (skew := self._latch_skew()) else {})

    def _latch_skew(self) -> dict[str, dict[str, float]]:
        """What `hdrig run skew` has measured on this bench, of the channels where it has; s."""
        sections = {"theta_l": self.file.load_encoder, "tau_l": self.file.torque_sensor}
        return {
            channel: {"value": section.skew, "half_width": section.skew_half_width}
            for channel, section in sections.items()
            if section is not None and section.skew is not None and section.skew_half_width is not None
        }

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
        made = {role: self._device(role, wiring, self._place(role)) for role in ROLES if self._has(role)}
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

    def _place(self, role: str) -> Any:
        """What the driver of `role` is told of the bench."""
        from drivers.wiring import Place

        f, limits = self.file, self.limits
        side = f.load_encoder if role == "load_encoder" else f.motor
        return Place(
            role=role,
            options=getattr(f.devices, role).options(),
            counts_per_turn=side.counts_per_turn if side else 0,
            torque_rated=f.motor.torque_rated,
            torque_limit=min(f.motor.torque_limit, f.limits.torque),
            speed_limit=limits.speed / (f.gear.N if role == "load_encoder" else 1.0),
            following=limits.following + limits.following_time * limits.speed,
            range=f.torque_sensor.range if f.torque_sensor else 0.0,
            period=1.0 / f.loop.rate,
            stale=limits.stale,
        )

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


def read(source: str, overrides: Iterable[str] = ()) -> Bench:
    """The bench called `source` (a file, or the name of one that ships), with `key=value` overrides.

    Raises UsageError: no such bench, an override that fits nothing, a key or value that is wrong.
    """
    path = Path(source) if source.endswith(".toml") or "/" in source else BENCHES / f"{source}.toml"
    if path.parent == BENCHES and source not in {p.stem for p in BENCHES.glob("*.toml")}:
        known = [p.stem for p in BENCHES.glob("*.toml")]
        raise UsageError(f"no bench called '{source}'; {nearest(source, known)}; or give the path of a .toml file")
    text = load_text(path)
    assignments = list(overrides)
    if assignments:
        read_bench(text, str(path))  # what is wrong in the file itself is said first
        text = override(text, assignments, str(path))
    bench = Bench(read_bench(text, str(path)), text, str(path))
    check_together(bench.source, bench.file)
    for role in ROLES:
        if (made := bench.device(role)) is not None:
            check_keys(bench.source, role, getattr(bench.file.devices, role), getattr(made, "keys", ()))
    return bench


def override(text: str, assignments: list[str], source: str, origin: str = "declared") -> str:
    """The TOML `text` with `a.b=value` assignments made, said to be from `origin`; comments and the rest stay."""
    if not assignments:
        return text
    import tomlkit

    document = tomlkit.parse(text)

    def keys(at: Any) -> list[str]:
        return [str(key) for key in at] if isinstance(at, dict) else []

    for assignment in assignments:
        key, equals, value = assignment.partition("=")
        if not equals:
            raise UsageError(f"--set {assignment}: expected key=value, for example control.Kp=5")
        at: Any = document
        *path, last = key.strip().split(".")
        for part in path:
            if not isinstance(at, dict) or part not in at:
                raise UsageError(f"--set {assignment}: no section '{part}' in {source}; {nearest(part, keys(at))}")
            at = at[part]
        if not isinstance(at, dict) or last not in at:
            raise UsageError(f"--set {assignment}: no key '{key.strip()}' in {source}; {nearest(last, keys(at))}")
        parsed = toml_value(value)
        if isinstance(at[last], dict) and "value" in at[last]:
            at[last]["value"], at[last]["from"] = parsed, origin
        else:
            at[last] = parsed
    return tomlkit.dumps(document)


def toml_value(text: str) -> Any:
    """A value as TOML writes it; what is no TOML value is taken as a string."""
    try:
        return tomllib.loads(f"x = {text}")["x"]
    except (ValueError, RecursionError):
        return text.strip()


def device_class(kind: str, where: str) -> Callable[..., Device]:
    """The class behind a device type. Raises UsageError naming the nearest that exists."""
    import drivers
    import sim

    catalogue: dict[str, str] = {**sim.CATALOGUE, **drivers.CATALOGUE}
    if kind not in catalogue:
        raise UsageError(f"{where} = '{kind}': no such device; {nearest(kind, catalogue)}")
    module, _, name = catalogue[kind].partition(":")
    found: Callable[..., Device] = getattr(importlib.import_module(module), name)
    return found


def twin_parameters(f: BenchFile) -> Any:
    """The numbers of the bench file as the twin wants them."""
    import numpy as np

    from sim.effects import Effects
    from sim.parameters import TwinParameters

    twin, gear = f.twin, f.gear
    assert twin is not None
    error = FourierSeries.from_polar(np.radians(twin.kinematic_error.C_deg), np.radians(twin.kinematic_error.psi_deg))
    model = Gear(
        ratio=gear.N, J_m=gear.J_m, J_l=gear.J_l, K=gear.K, B_m=gear.B_m, B_l=gear.B_l, B_ml=gear.B_ml, B_sp=gear.B_sp,
        kinematic_error=error, sigma=sigma_of(gear.output),
        tau_c=twin.tau_c, tau_s=twin.tau_s, omega_s=twin.omega_s, F_cl=twin.F_cl,
    )  # fmt: skip
    return TwinParameters(
        gear=model,
        friction_noise=twin.friction_noise,
        friction_noise_s=twin.friction_noise_s,
        tau_drive=twin.tau_drive,
        torque_limit=f.motor.torque_limit,
        torque_resolution=twin.torque_resolution,
        torque_noise=twin.torque_noise,
        watchdog=twin.watchdog,
        motor_counts_per_turn=f.motor.counts_per_turn,
        load_counts_per_turn=f.load_encoder.counts_per_turn if f.load_encoder else 1,
        sensor_range=f.torque_sensor.range if f.torque_sensor else 1.0,
        sensor_noise=twin.sensor_noise,
        sensor_zero=twin.sensor_zero,
        sensor_lowpass_hz=twin.sensor_lowpass_hz,
        sensor_resolution=twin.sensor_resolution,
        latch_m=twin.latch_m,
        latch_l=twin.latch_l,
        latch_tau=twin.latch_tau,
        effects=Effects.of(twin.effects.model_dump()),
    )
