"""What a drive does with its motor while its power stage is on: modes, braking, limits, following error."""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple, final

from sim.wire.agenda import Agenda, Timer
from sim.wire.motor import Motor, wrapped
from sim.wire.objects import Entry
from sim.wire.servo import PERIOD, Braking, Loop, PositionLoop, VelocityLoop

REVOLUTION = 2.0 * math.pi


class Mode(IntEnum):
    """Modes of operation 6060."""

    NONE = 0
    CSP = 8
    CSV = 9
    CST = 10


SUPPORTED = 1 << 7 | 1 << 8 | 1 << 9  # 6502: csp, csv, cst


class Settings(NamedTuple):
    """The objects that motion follows, read when they are needed."""

    target_torque: Entry  # 6071, per mille of rated torque
    target_position: Entry  # 607A, counts
    target_velocity: Entry  # 60FF, counts/s
    max_torque: Entry  # 6072, per mille of rated torque
    window: Entry  # 6065, counts
    window_time: Entry  # 6066, ms
    deceleration: Entry  # 6085, counts/s²
    interval: Entry  # 60C2:01, ms


@final
class Motion:
    """`late` is called when the following error has been too large for too long."""

    def __init__(
        self, agenda: Agenda, motor: Motor, settings: Settings, torque_rated: float, late: Callable[[], None]
    ) -> None:
        self.motor, self.settings, self.torque_rated, self._late = motor, settings, torque_rated, late
        self.mode = Mode.NONE
        self.on = False  # following the targets
        self.limited = False  # the torque is at its limit
        self._loop: Loop | None = None
        self._braking: Braking | None = None
        self._stopped: Callable[[], None] = lambda: None
        self._overdue = 0.0  # s for which the following error has been too large
        self._ticker = Timer(agenda, self._tick)

    def follow(self) -> None:
        """Follow the targets of the mode. A position is held where it is until a target comes."""
        self.release()
        self.on = True
        parameters, settings = self.motor.world.parameters, self.settings
        match self.mode:
            case Mode.CST:
                self.aim_torque(settings.target_torque.number)
            case Mode.CSV:
                self._loop = VelocityLoop(parameters)
                self.aim_velocity(settings.target_velocity.number)
                self._tick()
            case Mode.CSP:
                self._loop = PositionLoop(parameters, self.motor.sample().theta, settings.interval.number * 1e-3)
                self._tick()

    def release(self) -> None:
        """Torque off."""
        self.on = self.limited = False
        self._loop = self._braking = None
        self._overdue = 0.0
        self._ticker.stop()
        self.motor.drive(0.0)

    def brake(self, stopped: Callable[[], None]) -> None:
        """Come to rest at 6085, call `stopped`, hold."""
        self.release()
        slowdown = self.motor.radians_per_second(self.settings.deceleration.number)
        self._braking = Braking(self.motor.world.parameters, self.motor.sample().omega, slowdown)
        self._stopped = stopped
        self._tick()

    def change(self, mode: Mode) -> None:
        """Another mode; at once when it is following."""
        self.mode = mode
        if self.on:
            self.follow()

    def aim_torque(self, permille: float) -> None:
        """6071 has come."""
        if self.on and self.mode is Mode.CST:
            self._drive(permille / 1000.0 * self.torque_rated)

    def aim_velocity(self, counts: float) -> None:
        """60FF has come."""
        if self._loop is not None and self.mode is Mode.CSV:
            self._loop.aim(self.motor.radians_per_second(counts))

    def aim_position(self, counts: float) -> None:
        """607A has come."""
        if self._loop is not None and self.mode is Mode.CSP:
            self.motor.sample()
            self._loop.aim(self.motor.angle(counts))

    def torque_actual(self) -> int:
        """Per mille of rated torque now."""
        self.motor.sample()
        return max(-0x8000, min(0x7FFF, round(1000.0 * self.motor.tau / self.torque_rated)))

    def following_error(self) -> int:
        """Counts that the demand is ahead now; zero where no position is demanded."""
        if self._loop is None:
            return 0
        turns = self._loop.following_error(self.motor.sample().theta) / REVOLUTION
        return wrapped(turns * self.motor.counts_per_turn)

    def too_far(self) -> bool:
        """Whether the following error is outside its window."""
        return abs(self.following_error()) > self.settings.window.number

    @property
    def _limit(self) -> float:
        """N·m: 6072, and what the motor can give."""
        asked = self.settings.max_torque.number / 1000.0 * self.torque_rated
        return min(asked, self.motor.world.parameters.torque_limit)

    def _drive(self, tau: float) -> None:
        limit = self._limit
        self.limited = not abs(tau) <= limit
        self.motor.drive(math.copysign(limit, tau) if self.limited else tau)

    def _tick(self) -> None:
        loop = self._braking or self._loop
        assert loop is not None
        self._drive(loop.torque(self.motor.sample(), self._limit))
        self._ticker.start(PERIOD)
        if self._braking is not None and self._braking.finished:
            stopped, self._stopped = self._stopped, lambda: None
            stopped()
        elif self.too_far():
            self._overdue += PERIOD
            if self._overdue * 1e3 > self.settings.window_time.number:
                self._late()
        else:
            self._overdue = 0.0
