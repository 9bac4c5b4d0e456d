"""The twin's servo drive: CiA 402 in behaviour, SI in its words, with the motor's encoder."""

from __future__ import annotations

import math

from rig.core.devices import Drive, DriveReading, Identity, torque_only
from rig.core.errors import HdrigError, NotReady
from rig.core.sample import Mode, Setpoint
from sim.channel import DRIVE_SATURATED, FINEST, SIMULATED, UNREAD, Counter, new
from sim.encoder import motor_scale
from sim.faults import Fault
from sim.noise import normal
from sim.world import World


class TwinDrive(Drive):
    """Torque-controlled: rounds to its resolution, clips at its limit, lets go when nobody talks to it.

    The encoder counts from power-up, so that the phase of the kinematic error differs from seed to seed;
    `encoder.zero` is the motor's angle there, as the scale shows it. The torque follows through a first-order loop in
    the plant.
    """

    name = "drive"

    def __init__(self, world: World) -> None:
        p = world.parameters
        self.world = world
        self._plant = world.plant
        scale = motor_scale(p.effects.sensors)
        self.encoder = Counter(p.motor_counts_per_turn, scale.shown(world.plant.motor[0]))
        self._shown = scale.shown if scale.lines else None
        self.fault: Fault | None = None  # of its encoder
        self.deaf = False  # commands no longer arrive
        self.trouble = ""  # the drive's own fault, latched, in words
        self._resolution = max(p.torque_resolution, FINEST)
        self._limit = p.torque_limit
        self._watchdog = p.watchdog
        self._latch = p.latch_m
        self._latched = p.latch_m + p.effects.sensors.motor_skew  # s after the tick, in truth
        self._noise = normal(world.seed, "drive torque", p.torque_noise)
        self._connected = False
        self._enabled = False
        self._flags = SIMULATED
        self._read_at = UNREAD
        self._last: DriveReading | None = None

    def connect(self) -> Identity:
        """Always there."""
        self._connected = True
        return Identity("twin drive", f"seed {self.world.seed}")

    def close(self) -> None:
        """Torque off, then gone."""
        self.halt()
        self._connected, self._read_at = False, UNREAD

    def enable(self, mode: Mode = Mode.TORQUE) -> None:
        """Zero torque. Raises NotReady: not connected, or a fault is latched.

        The watchdog starts with the first command, as a CANopen heartbeat consumer does with the first heartbeat.
        """
        torque_only("the twin's drive", mode)
        self._expect_connection()
        if self.trouble:
            raise NotReady(f"the drive does not enable: {self.trouble}; reset the fault first")
        if self.deaf:
            raise NotReady("the drive does not enable: it does not answer")
        if not self._enabled:
            self._enabled = True
            self.world.command(0.0)

    def read(self) -> DriveReading:
        """The newest reading; the same one again until time has passed. Raises NotReady when not connected."""
        world = self.world
        if world.t == self._read_at and self._last is not None:
            return self._last
        if not self._connected:
            self._expect_connection()
        theta, omega, acceleration = self._plant.motor
        dt = self._latched
        theta += dt * (omega + 0.5 * dt * acceleration)
        encoder = self.encoder
        if self._shown is not None:
            theta = self._shown(theta)
        if self.fault is not None:
            theta = encoder.distorted(theta, self.fault.value)
        counts = encoder.count(theta)
        tau = self._resolution * round((self._plant.shaft[0] + self._noise()) / self._resolution)
        reading = new(
            DriveReading, (world.t + self._latch, counts * encoder.step, counts, tau, self._flags, self.trouble)
        )
        if self.fault is not None:
            reading = self.fault.reading(reading, self._last or reading)
        self._last, self._read_at = reading, world.t
        return reading

    def write(self, setpoint: Setpoint) -> float:
        """Command a torque; gives the one that was carried. Raises HdrigError when it is no number."""
        if not self._enabled:
            return 0.0
        tau = asked = setpoint[0]
        limit = self._limit
        if not -limit <= tau <= limit:
            if math.isnan(tau):
                raise HdrigError("the drive was asked for a torque that is not a number")
            tau = math.copysign(limit, tau)
        carried = self._resolution * round(tau / self._resolution)
        if abs(carried) > limit:  # the limit need not be a whole number of steps
            carried -= math.copysign(self._resolution, carried)
        if not self.deaf:
            self._flags = SIMULATED if tau == asked else DRIVE_SATURATED
            self.world.command(carried, self.world.t + self._watchdog, self._lapsed)
        return carried

    def halt(self) -> bool:
        """Torque off; True unless the drive is not connected or does not listen."""
        if not self._connected or self.deaf:
            return False
        self._let_go()
        return True

    def reset_fault(self) -> None:
        """Forget the latched fault; the drive stays without torque. Raises NotReady when not connected."""
        self._expect_connection()
        self.trouble = ""
        self._read_at = UNREAD

    def trip(self, reason: str) -> None:
        """The drive's own protection acts: torque off, fault latched; the first reason stays."""
        self._let_go()
        self.trouble = self.trouble or reason

    def _let_go(self) -> None:
        self._enabled, self._flags, self._read_at = False, SIMULATED, UNREAD
        self.world.command(0.0)

    def _lapsed(self) -> None:
        self.trip(f"watchdog: no command for {self._watchdog * 1e3:g} ms")

    def _expect_connection(self) -> None:
        if not self._connected:
            raise NotReady("the twin's drive is not connected")
