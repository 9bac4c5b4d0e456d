"""The twin's load encoder and torque sensor. Each is latched at its own time after the tick, and says when."""

from __future__ import annotations

import math

from rig.core.devices import AngleReading, Encoder, Identity, TorqueReading, TorqueSensor
from rig.core.errors import NotReady
from sim.channel import FINEST, SENSOR_SATURATED, SIMULATED, UNREAD, Counter, new
from sim.encoder import load_scale
from sim.faults import Fault
from sim.noise import normal
from sim.torque_aside import torque_aside
from sim.world import World


class TwinLoadEncoder(Encoder):
    """Counts from power-up; `encoder.zero` is the load's angle there, as the scale shows it."""

    name = "load_encoder"

    def __init__(self, world: World) -> None:
        self.world = world
        self._plant = world.plant
        p = world.parameters
        scale = load_scale(p.effects.sensors)
        self.encoder = Counter(p.load_counts_per_turn, scale.shown(world.plant.load[0]))
        self._shown = scale.shown if scale.lines else None
        self.fault: Fault | None = None
        self._latch = p.latch_l
        self._latched = p.latch_l + p.effects.sensors.load_skew  # s after the tick, in truth
        self._connected = False
        self._read_at = UNREAD
        self._last: AngleReading | None = None

    def connect(self) -> Identity:
        """Always there."""
        self._connected = True
        return Identity("twin load encoder", f"seed {self.world.seed}")

    def close(self) -> None:
        """Gone."""
        self._connected, self._read_at = False, UNREAD

    def read(self) -> AngleReading:
        """The newest angle; the same reading again until time has passed. Raises NotReady when not connected."""
        world = self.world
        if world.t == self._read_at and self._last is not None:
            return self._last
        if not self._connected:
            raise NotReady("the twin's load encoder is not connected")
        theta, omega, acceleration = self._plant.load
        dt = self._latched
        theta += dt * (omega + 0.5 * dt * acceleration)
        encoder = self.encoder
        if self._shown is not None:
            theta = self._shown(theta)
        if self.fault is not None:
            theta = encoder.distorted(theta, self.fault.value)
        counts = encoder.count(theta)
        reading = new(AngleReading, (world.t + self._latch, counts * encoder.step, counts, SIMULATED))
        if self.fault is not None:
            reading = self.fault.reading(reading, self._last or reading)
        self._last, self._read_at = reading, world.t
        return reading


class TwinTorqueSensor(TorqueSensor):
    """All the gear gives to the load, behind a first-order low-pass, with zero offset, noise, resolution and range.

    The low-pass runs in the plant; between tick and latch its input is taken as a straight line. Bending of the shaft,
    a warming zero and pickup come on top as `effects.sensors` says.
    """

    name = "torque_sensor"

    def __init__(self, world: World) -> None:
        p = world.parameters
        self.world = world
        self._plant = world.plant
        self.fault: Fault | None = None
        self._latch = p.latch_tau
        self._latched = p.latch_tau + p.effects.sensors.torque_skew  # s after the tick, in truth
        self._aside = torque_aside(p.effects.sensors)
        self._time_constant = 1.0 / (2.0 * math.pi * p.sensor_lowpass_hz)  # s
        self._keep = math.exp(-max(self._latched, 0.0) / self._time_constant)
        self._zero = p.sensor_zero
        self._range = p.sensor_range
        self._resolution = max(p.sensor_resolution, FINEST)
        self._noise = normal(world.seed, "torque sensor", p.sensor_noise)
        self._connected = False
        self._read_at = UNREAD
        self._last: TorqueReading | None = None

    def connect(self) -> Identity:
        """Always there."""
        self._connected = True
        return Identity("twin torque sensor", f"seed {self.world.seed}")

    def close(self) -> None:
        """Gone."""
        self._connected, self._read_at = False, UNREAD

    def read(self) -> TorqueReading:
        """The newest torque; the same reading again until time has passed. Raises NotReady when not connected."""
        world = self.world
        if world.t == self._read_at and self._last is not None:
            return self._last
        if not self._connected:
            raise NotReady("the twin's torque sensor is not connected")
        _, tau_l, rate, filtered = self._plant.shaft
        dt, lag = self._latched, rate * self._time_constant
        tau = tau_l + rate * dt - lag + (filtered - tau_l + lag) * self._keep + self._zero + self._noise()
        if self._aside is not None:
            tau += self._aside(world.t + dt, self._plant.load[0])
        if self.fault is not None:
            tau = self.fault.value(tau)
        flags, limit = SIMULATED, self._range
        if not -limit < tau < limit:
            tau, flags = math.copysign(limit, tau), SENSOR_SATURATED
        tau = self._resolution * round(tau / self._resolution)
        reading = new(TorqueReading, (world.t + self._latch, tau, flags))
        if self.fault is not None:
            reading = self.fault.reading(reading, self._last or reading)
        self._last, self._read_at = reading, world.t
        return reading
