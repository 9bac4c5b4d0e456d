"""An ODrive axis at the twin's motor, as it behaves on a CAN bus with firmware 0.6: CANSimple      [odrive]

Only what a rig in torque control meets: heartbeat, version, estimates, torques, current, states, limits, watchdog. The
position it tells is its encoder's count; the maker's filter behind it (1000 rad/s) is not modelled. Its hardware
version is 0.0, which no board has.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum, IntFlag
from typing import final

from sim.wire.agenda import Timer
from sim.wire.bus import Bus
from sim.wire.frame import REMOTE, Frame
from sim.wire.motor import Motor, Rating
from sim.world import World

FIRMWARE = bytes((2, 0, 0, 0, 0, 6, 10, 0))  # answer to Get_Version: protocol, hardware 3 ×, firmware 3 ×, unreleased
BOOT = 0.3  # s from power to the first heartbeat
MAIN_LOOP = 1.0 / 8000.0  # s: a command takes effect, a state changes, with the next run of the control loop
OVERSPEED = 1.2  # of the speed limit: beyond it the axis disarms
DATA = 8  # bytes of what it tells


class State(IntEnum):
    """Axis states it can be in."""

    UNDEFINED = 0
    IDLE = 1
    CLOSED_LOOP_CONTROL = 8


class Error(IntFlag):
    """What can be wrong with it."""

    INITIALIZING = 0x1
    BAD_CONFIG = 0x10
    DC_BUS_UNDER_VOLTAGE = 0x200
    VELOCITY_LIMIT_VIOLATION = 0x8000
    WATCHDOG_TIMER_EXPIRED = 0x1000000
    ESTOP_REQUESTED = 0x2000000


OLD = {  # the same in firmware 0.5; what it does not know there is "invalid state"
    Error.WATCHDOG_TIMER_EXPIRED: 0x800,
    Error.ESTOP_REQUESTED: 0x4000,
    Error.VELOCITY_LIMIT_VIOLATION: 0x200,
}


@dataclass(frozen=True)
class Settings:
    """What somebody saved in it over USB. 0 s: not sent of its own accord; a watchdog of 0 s is off."""

    heartbeat: float = 0.1
    estimates: float = 0.01
    torques: float = 0.0
    watchdog: float = 0.0
    speed_limit: float = 20.0  # turns/s
    calibrated: bool = True
    knows_torque: bool = True  # firmware 0.6; an older one tells neither torque nor version


@final
class Axis:
    """`node` 0 to 63 on a bus of its own kind."""

    def __init__(self, bus: Bus, node: int, world: World, rating: Rating, settings: Settings | None = None) -> None:
        self.agenda, self.node, self.rating = bus.agenda, node, rating
        self.settings = settings or Settings()
        self.motor = Motor(world, bus.agenda)
        self.port = bus.attach(f"ODrive node {node}", self._receive)
        self._told: dict[int, Callable[[], bytes]] = {
            0x01: lambda: struct.pack("<IBBBB", self._bits(), self.state, 0, 0, 0),
            0x03: lambda: struct.pack("<II", self._bits(), self.disarmed_by),
            0x09: self._estimates,
            0x14: lambda: struct.pack("<ff", self._target() / rating.constant, self._tau() / rating.constant),
        }
        if self.settings.knows_torque:
            self._told |= {0x00: lambda: FIRMWARE, 0x1C: lambda: struct.pack("<ff", self._target(), self._tau())}
        self._orders: dict[int, Callable[[bytes], None]] = {
            0x02: lambda data: self.fail(Error.ESTOP_REQUESTED),
            0x07: lambda data: self._request(*struct.unpack_from("<I", data)),
            0x0B: self._set_mode,
            0x0E: self._set_torque,
            0x0F: self._set_limits,
            0x16: lambda data: self.power_up(),
            0x18: lambda data: self._clear(),
        }
        self._watchdog = Timer(bus.agenda, lambda: self.fail(Error.WATCHDOG_TIMER_EXPIRED))
        self._life = 0
        self.power_up()

    def power_up(self) -> None:
        """From nothing but what is saved; position zero is here."""
        self._life += 1
        self.state, self.error, self.disarmed_by = State.UNDEFINED, Error(0), Error(0)
        self.control_mode, self.input_mode, self.input_torque = 3, 1, 0.0  # position control, passed through
        self.speed_limit, self.current_limit = self.settings.speed_limit, math.inf
        self._disarm()
        self._zero = self.motor.position
        self._watchdog.stop()
        life = self._life
        self.agenda.after(BOOT, lambda: self._booted() if life == self._life else None)

    def _booted(self) -> None:
        self.state = State.IDLE
        self._feed()
        for command, period in ((0x01, self.settings.heartbeat), (0x09, self.settings.estimates)):
            self._cycle(command, period, self._life)
        if self.settings.knows_torque:
            self._cycle(0x1C, self.settings.torques, self._life)

    def _cycle(self, command: int, period: float, life: int) -> None:
        if period > 0.0 and life == self._life:
            self._tell(command)
            self.agenda.after(period, lambda: self._cycle(command, period, life))

    def fail(self, error: Error) -> None:
        """Its own protection acts: disarmed at once, idle from the next loop on."""
        if not self.error:
            self.disarmed_by = error
        self.error |= error
        self._disarm()

    def _bits(self) -> int:
        if self.settings.knows_torque:
            return self.error
        return sum(OLD.get(error, 0x1) for error in self.error)

    def _disarm(self) -> None:
        self.motor.drive(0.0)
        if self.state is State.CLOSED_LOOP_CONTROL:
            self.state = State.IDLE

    # ---- frames ----

    def _receive(self, frame: Frame, t: float) -> None:
        number = frame.identifier & ~REMOTE
        if number >> 5 != self.node or self.state is State.UNDEFINED:  # flags of other kinds make it another number
            return
        self._feed()
        command = number & 0x1F
        if frame.identifier & REMOTE:
            if command in self._told:
                self.agenda.after(MAIN_LOOP, lambda: self._tell(command))
        elif command in self._orders:
            data = frame.data.ljust(DATA, b"\0")
            self.agenda.after(MAIN_LOOP, lambda: self._orders[command](data))

    def _feed(self) -> None:
        if self.settings.watchdog > 0.0:
            self._watchdog.start(self.settings.watchdog)

    def _tell(self, command: int) -> None:
        self.port.send(Frame(self.node << 5 | command, self._told[command]()))

    def _estimates(self) -> bytes:
        turns = (self.motor.position - self._zero) / self.motor.counts_per_turn
        speed = self.motor.speed / self.motor.counts_per_turn
        if abs(speed) > OVERSPEED * self.speed_limit and self.state is State.CLOSED_LOOP_CONTROL:
            self.fail(Error.VELOCITY_LIMIT_VIOLATION)
        return struct.pack("<ff", turns, speed)

    def _target(self) -> float:
        """N·m it is after now."""
        limit = min(self.motor.world.parameters.torque_limit, self.current_limit * self.rating.constant)
        wanted = self.input_torque if self.state is State.CLOSED_LOOP_CONTROL else 0.0
        return max(-limit, min(limit, wanted))

    def _tau(self) -> float:
        self.motor.sample()
        return self.motor.tau

    # ---- orders ----

    def _request(self, state: int) -> None:
        match state:
            case State.IDLE:
                self._disarm()
            case State.CLOSED_LOOP_CONTROL:
                self._arm()

    def _arm(self) -> None:
        if self.error:
            return
        if not self.settings.calibrated or (self.control_mode, self.input_mode) != (1, 1):
            self.fail(Error.BAD_CONFIG)  # this twin knows torque control only
            return
        self.state = State.CLOSED_LOOP_CONTROL
        self.motor.drive(self._target())

    def _set_mode(self, data: bytes) -> None:
        self.control_mode, self.input_mode = struct.unpack("<II", data)

    def _set_torque(self, data: bytes) -> None:
        self.input_torque = struct.unpack_from("<f", data)[0]
        if not math.isfinite(self.input_torque):
            self.input_torque = 0.0
        if self.state is State.CLOSED_LOOP_CONTROL:
            self.motor.drive(self._target())

    def _set_limits(self, data: bytes) -> None:
        self.speed_limit, self.current_limit = struct.unpack("<ff", data)

    def _clear(self) -> None:
        self.error, self.disarmed_by = Error(0), Error(0)
        self._feed()
