"""What a servo drive measures and what it does to the plant: encoder counts, observed speed, torque."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from sim.drive import TwinDrive
from sim.wire.agenda import Agenda
from sim.wire.servo import Motion
from sim.world import World

OBSERVER = 0.002  # s, time constant of the speed the drive makes of its counts
REVOLUTION = 2.0 * math.pi
INT32 = 1 << 32


CONSTANT = 0.5  # N·m/A, assumed: no bench file has one yet, and the twin's plant has no current


@dataclass(frozen=True)
class Rating:
    """The motor's plate."""

    torque: float  # N·m, 6076
    constant: float = CONSTANT  # N·m/A, torque per current, 6075 = 6076 / constant


def wrapped(value: float) -> int:
    """`value` as a signed 32-bit counter shows it."""
    return (round(value) + INT32 // 2) % INT32 - INT32 // 2


@final
class Motor:
    """The motor as its drive sees it. Counts start at zero when the drive is switched on."""

    def __init__(self, world: World, agenda: Agenda) -> None:
        self.world, self._agenda = world, agenda
        self.sensors = TwinDrive(world)
        self.sensors.connect()
        self.counts_per_turn = world.parameters.motor_counts_per_turn
        self.offset = 0  # counts added to the position: another zero, or close to a wrap
        self.omega = 0.0  # rad/s, observed
        self.tau = 0.0  # N·m, actual
        self.theta = 0.0  # rad
        self.counts = 0
        self._t = -math.inf
        self.sample()

    def sample(self) -> Motion:
        """Latch everything now; the same values again until time has passed."""
        world = self.world
        world.advance_to(self._agenda.now)
        if world.t > self._t:
            reading = self.sensors.read()
            elapsed = world.t - self._t
            rate = (reading.theta_m - self.theta) / elapsed
            self.omega += (rate - self.omega) * -math.expm1(-elapsed / OBSERVER) if self._t >= 0.0 else 0.0
            self.theta, self.counts, self.tau, self._t = reading.theta_m, reading.counts, reading.tau_m, world.t
        return Motion(self.theta, self.omega)

    def drive(self, tau: float) -> None:
        """Ask the torque loop for `tau` N·m from now on."""
        self.world.advance_to(self._agenda.now)
        self.world.command(tau)

    @property
    def position(self) -> int:
        """Counts now, as the 32-bit register holds them."""
        self.sample()
        return wrapped(self.counts + self.offset)

    @property
    def speed(self) -> int:
        """Counts per second now."""
        self.sample()
        return wrapped(self.omega / REVOLUTION * self.counts_per_turn)

    def angle(self, counts: float) -> float:
        """The angle [rad] next to here that a 32-bit target of `counts` means."""
        return self.theta + wrapped(counts - self.position) / self.counts_per_turn * REVOLUTION

    def radians_per_second(self, counts: float) -> float:
        """Counts per second to rad/s."""
        return counts / self.counts_per_turn * REVOLUTION
