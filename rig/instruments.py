"""The devices of one bench as one instrument: a sample in, a setpoint out, and safe at any moment."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from dataclasses import dataclass

from rig.control.filter import SpeedFilter
from rig.core.channels import Flag
from rig.core.clock import NEVER, Clock
from rig.core.devices import Device, Drive, Encoder, Identity, TorqueSensor
from rig.core.errors import NotReady
from rig.core.operator import Operator
from rig.core.sample import NAN, Sample, Setpoint
from rig.timing.latching import LatchOffsets

FROZEN = 1.0  # s of the very same torque: noise alone would have changed it
STALE_M, STALE_L, STALE_TAU = int(Flag.STALE_M), int(Flag.STALE_L), int(Flag.STALE_TAU)
FROZEN_TAU = int(Flag.FROZEN_TAU)  # plain integers: one operation on an enum costs as much as a whole reading
new = tuple.__new__  # half the cost of a NamedTuple's own constructor, paid every tick
GLANCE = 0.05  # s between two looks that tell a turning motor: one count of 2000 a turn is 0.06 rad/s in it
TURNS = 0.5  # rad/s, 5 rpm: a motor that is slower has come to rest, but for the noise of its speed
LOOKS, APART = 10, 0.01  # looks at the shaft torque of a rig at rest, s between two
UNREAD = 0.4  # s without a look, from which on a line may have thrown away what it kept
GLIMPSE = 0.005  # s between two looks at what has to tell something new
PATIENCE = 0.2  # s for that before anything is energised: two messages of a line that sends ten a second
ENERGISED = 0.05  # s for it once a drive is: the benches that ship have watchdogs of 0.1 s and more
UNTOLD = Flag.STALE_TAU | Flag.FROZEN_TAU | Flag.SATURATED_TAU  # of a torque that is not that of now
ANSWER = 0.02  # s outside of a run: bus, adapter and a pseudo terminal on a busy machine


@dataclass
class Instruments:
    """A drive, and where the bench has them a load encoder and a torque sensor. Absent channels read NaN."""

    drive: Drive
    load_encoder: Encoder | None
    torque_sensor: TorqueSensor | None
    clock: Clock
    speed_filter: SpeedFilter
    operator: Operator | None = None  # whose hand changes weights and pins; None where that is a person
    latch: Callable[[], None] | None = None  # has devices on a bus take their readings now; None: they do so unasked
    lead: float = 0.0  # s between that and the tick that reads them

    def __post_init__(self) -> None:
        self.started = 0.0  # s on the clock: t = 0 of the run
        self._looked = self.clock.now()  # s on it: when a sample was last taken
        self._last = [NEVER, NEVER, NEVER]  # latch times seen last: motor, load, torque
        self.offsets = (LatchOffsets(), LatchOffsets())  # of load angle and torque, against the motor angle, as told
        self._mark = 0  # flags every row carries
        self.broken = ""  # what came out of a driver that was told to take the torque off, in words
        self._tau, self._tau_since = NAN, 0.0  # the torque sensor's last value, and when it was first that [s]

    @property
    def devices(self) -> tuple[Device, ...]:
        """Those the bench has."""
        return tuple(d for d in (self.drive, self.load_encoder, self.torque_sensor) if d is not None)

    @property
    def channels(self) -> frozenset[str]:
        """What a sample will hold."""
        own = {"t", "theta_m", "omega_m", "tau_m"}
        return frozenset(
            own | ({"theta_l"} if self.load_encoder else set()) | ({"tau_l"} if self.torque_sensor else set())
        )

    def connect(self) -> dict[str, Identity]:
        """Open every device; if one refuses or breaks, close those already open. Raises NotReady."""
        found: dict[str, Identity] = {}
        try:
            for device in self.devices:
                found[device.name] = device.connect()
        except BaseException:
            self.close()
            raise
        self._looked = self.clock.now()  # each driver has heard its device
        if any(identity.simulated for identity in found.values()):
            self._mark = int(Flag.SIMULATED)  # the twin over a wire, whose drivers cannot know
        elif self.operator is not None:
            self.close()
            raise NotReady("the bench file has a [hand], as a twin has, and no device here says that it is simulated")
        return found

    def causes(self) -> str:
        """What is wrong with the devices as of their last readings, the first of it; "" when nothing is."""
        return next((device.trouble for device in self.devices if device.trouble), "")

    def silent(self) -> str:
        """Which message of which device stays away while its others come, the first of them; "" when none does."""
        return next((device.silent for device in self.devices if device.silent), "")

    def start(self) -> None:
        """From here time counts from zero, and nothing read before is news. Called again it counts anew."""
        self.started = self.clock.wait_until(self.clock.now())  # lets a simulated world catch up with a wall clock
        self._last = [NEVER, NEVER, NEVER]
        self.offsets = (LatchOffsets(), LatchOffsets())
        self._tau = NAN
        self.speed_filter = SpeedFilter(self.speed_filter.time_constant)

    def read(self, now: float) -> Sample:
        """The newest of every channel; never waits. `now` is when the tick began [s]: age is counted from there, by the
        devices' own latch times, so that a host that stalls within a tick does not pass for a silent device.
        """
        last, self._looked = self._last, now
        t_m, theta_m, counts_m, tau_m, flags, fault = self.drive.read()
        flags |= self._mark
        if t_m == last[0]:
            flags |= STALE_M
        oldest = last[0] = t_m
        theta_l, counts_l, tau_l = NAN, 0, NAN
        encoder, sensor = self.load_encoder, self.torque_sensor
        if encoder is not None:
            t_l, theta_l, counts_l, more = encoder.read()
            flags |= more
            fault = fault or encoder.trouble
            if t_l == last[1]:
                flags |= STALE_L
            last[1] = t_l
            self.offsets[0].add(t_l - t_m)
            if t_l < oldest:
                oldest = t_l
        if sensor is not None:
            t_tau, tau_l, more = sensor.read()
            flags |= more
            fault = fault or sensor.trouble
            if t_tau == last[2]:
                flags |= STALE_TAU
            if tau_l != self._tau:
                self._tau, self._tau_since = tau_l, t_tau
            elif t_tau - self._tau_since > FROZEN:
                flags |= FROZEN_TAU
            last[2] = t_tau
            self.offsets[1].add(t_tau - t_m)
            if t_tau < oldest:
                oldest = t_tau
        t = t_m - self.started
        omega = self.speed_filter.step(t, theta_m)
        return new(Sample, (t, theta_m, theta_l, omega, tau_m, tau_l, now - oldest, counts_m, counts_l, flags, fault))

    def look(self) -> Sample:
        """A sample outside of a run: devices that read when they are asked are asked, and given time to answer."""
        asked = self.clock.now()
        if self.latch is None:
            return self.read(self.clock.wait_until(asked))
        self.latch()
        return self.read(self.clock.wait_until(asked + ANSWER))

    def wake(self, oldest: float, patience: float = PATIENCE) -> None:
        """Looks, for `patience` s at most, until nothing is older than `oldest` s and what a look itself takes, where
        nobody has looked for a while: a line may have thrown away what it kept, and tells something new with its next
        message. Who stays silent all the same is not this one's to say.
        """
        oldest, give_up = max(oldest, 2 * ANSWER), self.clock.now() + patience
        if self.clock.now() - self._looked <= UNREAD:
            return
        while self.look().age > oldest and self.clock.now() < give_up:
            self.clock.wait_until(self.clock.now() + GLIMPSE)

    def still_carried(self, fresh: float) -> float | None:
        """Mean of a few looks at the shaft torque, N·m; None where the sensor says nothing of now, silent for `fresh` s
        or past its range, or where there is none."""
        looks = []
        for _ in range(LOOKS):
            self.clock.wait_until(self.clock.now() + APART)
            looks.append(self.look())
        told = [look.tau_l for look in looks if look.age <= fresh and not look.flags & UNTOLD]
        told = [tau for tau in told if math.isfinite(tau)]
        return sum(told) / len(told) if told else None

    def still_turning(self, patience: float, meanwhile: Callable[[], None] = lambda: None) -> float:
        """Speed, rad/s, of a motor without torque that has not come to rest in `patience` s; 0 of one that has, or that
        tells no new angle. `meanwhile` is called as long as it turns, and may raise.
        """
        give_up = self.clock.now() + patience
        while abs(speed := self._speed_seen()) > TURNS:
            meanwhile()
            if self.clock.now() > give_up:
                return speed
        return 0.0

    def _speed_seen(self) -> float:
        """Between two looks, rad/s; 0 where it tells no new angle."""
        before = self.look()
        self.clock.wait_until(self.clock.now() + GLANCE)
        sample = self.look()
        passed = sample.t - before.t
        return (sample.theta_m - before.theta_m) / passed if passed > 0.0 else 0.0

    def overdue(self, now: float, longest: float) -> int:
        """STALE flags of the channels with nothing newer at `now` [s] than `longest` s: a slow one is stale in most
        rows, and no reason for a trip.
        """
        there = ((self.drive, STALE_M), (self.load_encoder, STALE_L), (self.torque_sensor, STALE_TAU))
        late = (flag for (device, flag), t in zip(there, self._last, strict=True) if device and now - t > longest)
        return sum(late)

    def told(self) -> dict[str, dict[str, float | int]]:
        """Latch times against the motor angle's since `start`, of the channels that are there, as drivers tell them."""
        named = zip(("theta_l", "tau_l"), self.offsets, strict=True)
        return {name: offsets.summary() for name, offsets in named if offsets.count}

    def write(self, setpoint: Setpoint) -> float:
        """Command the drive; returns what it could be given, in the unit of `setpoint`: N·m, rad/s or rad."""
        return self.drive.write(setpoint)

    def cut(self) -> None:
        """Torque off is commanded; nothing is waited for. `safe` has it confirmed. Never raises."""
        with contextlib.suppress(Exception):  # `safe` comes next, and says it
            self.drive.cut()

    def safe(self) -> bool:
        """Torque off, in any state, any number of times, never raises. True when the drive confirmed it: a driver that
        breaks on the way has not.
        """
        try:
            return self.drive.halt()
        except Exception as error:  # noqa: BLE001  whatever it is, a trip and its words come after
            self.broken = f"{type(error).__name__}: {error}"
            return False

    def close(self) -> None:
        """Torque off first, then let go of every device, whatever becomes of another."""
        self.safe()
        with contextlib.ExitStack() as closing:
            for device in reversed(self.devices):  # the drive first: the last one in is the first one out
                closing.callback(device.close)
