"""A servo drive after CiA 402 at the twin's motor: cyclic synchronous torque, velocity and position."""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import IntEnum
from typing import final

from sim.wire.agenda import Timer
from sim.wire.bus import Bus
from sim.wire.motor import Motor, Rating, wrapped
from sim.wire.node import COMMUNICATION, GENERIC, PROFILE, Node, NodeIdentity, State
from sim.wire.objects import I8, I16, I32, U8, U16, U32, Abort, AbortCode, Entry, Kind, Objects
from sim.wire.pdo import OFF, PdoDefault
from sim.wire.servo import PERIOD, Braking, Loop, PositionLoop, VelocityLoop
from sim.wire.states402 import FAULT_RESET, POWERED, TRANSITIONS, Command, DriveState, command
from sim.world import World


class Mode(IntEnum):
    """Modes of operation 6060."""

    NONE = 0
    CSP = 8
    CSV = 9
    CST = 10


SUPPORTED = 1 << 7 | 1 << 8 | 1 << 9  # 6502: csp, csv, cst
MODE_CHANGE = 0.002  # s from 6060 to 6061
REACTION = 0.001  # s in fault reaction at least
INCREMENTS, INCREMENTS_PER_SECOND = 0x00B50000, 0x00B50300  # 60A8, 60A9      [cia303-2]
VOLTAGE, REMOTE, LIMIT, FOLLOWS, FOLLOWING_ERROR = 1 << 4, 1 << 9, 1 << 11, 1 << 12, 1 << 13  # statusword
FOLLOWING, STO_FAULT, CONNECTION = 0x8611, 0xFF01, 0x8100  # error codes; STO has none in the profile
QUICK_STOP_STAYS = range(5, 9)  # 605A: stay in quick stop active


@final
class ServoDrive(Node):
    """6064 in encoder increments (608F), 606C and 60FF in increments/s, 6071 and 6077 in per mille of 6076 [mN·m].

    Guarded by heartbeat consumer 1016, node guarding 100C/100D and RPDO timeouts 140x:05; what happens then says 6007
    (0 nothing, 1 fault, 2 disable voltage, 3 quick stop) while the power stage is on.
    """

    profile_defaults = (
        {
            0: PdoDefault(0x200, 255, [0x60400010]),
            1: PdoDefault(0x300 | OFF, 255, [0x60400010, 0x60600008]),
            2: PdoDefault(0x400 | OFF, 255, [0x60400010, 0x607A0020]),
            3: PdoDefault(0x500 | OFF, 255, [0x60400010, 0x60FF0020]),
        },
        {
            0: PdoDefault(0x180, 255, [0x60410010]),
            1: PdoDefault(0x280 | OFF, 255, [0x60410010, 0x60610008]),
            2: PdoDefault(0x380 | OFF, 255, [0x60410010, 0x60640020]),
            3: PdoDefault(0x480 | OFF, 255, [0x60410010, 0x606C0020]),
        },
    )

    def __init__(self, bus: Bus, node_id: int, world: World, rating: Rating) -> None:
        self.world, self.rating = world, rating
        self.sto_active = False
        self.mode_stuck = False  # 6061 no longer follows 6060
        self.incurable = False  # the fault comes back when it is reset
        self._ticker = Timer(bus.agenda, self._tick)
        super().__init__(bus, node_id, NodeIdentity(0x00020192, "hdrig twin servo drive", 0x402, world.seed))

    # ---- objects ----

    def furnish(self, objects: Objects) -> None:
        self.motor = Motor(self.world, self.agenda)
        self.motor.drive(0.0)
        self.drive_state = DriveState.SWITCH_ON_DISABLED
        self.mode = Mode.NONE
        self.limited = False
        self._loop: Loop | None = None
        self._braking: Braking | None = None
        self._then: DriveState | None = None  # where braking ends
        self._late = 0.0  # s for which the following error has been too large
        self._ticker.stop()
        self._control_objects(objects)
        self._motion_objects(objects)
        self._plate(objects)

    def _control_objects(self, o: Objects) -> None:
        self.abort_option = o.add(0x6007, Entry(I16, 1))
        self.error_code = o.add(0x603F, Entry(U16, 0, "r", mappable=True))
        self.controlword = o.add(0x6040, Entry(U16, 0, write=self._control, mappable=True))
        self.statusword = o.add(0x6041, Entry(U16, 0, "r", read=self._status, mappable=True))
        self.quick_stop_option = o.add(0x605A, Entry(I16, 2))
        o.add(0x605C, Entry(I16, 0))  # disable operation: torque off, coast
        self.fault_option = o.add(0x605E, Entry(I16, 0))
        o.add(0x6060, Entry(I8, 0, write=self._set_mode, mappable=True))
        o.add(0x6061, Entry(I8, 0, "r", read=lambda: self.mode, mappable=True))
        o.add(0x6502, Entry(U32, SUPPORTED, "r"))
        o.add(0x60FD, Entry(U32, 0, "r", read=lambda: self.sto_active << 3, mappable=True))  # bit 3: interlock

    def _motion_objects(self, o: Objects) -> None:
        def actual(index: int, kind: Kind, read: Callable[[], float]) -> None:
            o.add(index, Entry(kind, 0, "r", read=read, mappable=True))

        actual(0x6064, I32, lambda: self.motor.position)
        actual(0x606C, I32, lambda: self.motor.speed)
        actual(0x6077, I16, self._torque_actual)
        actual(0x6078, I16, self._torque_actual)  # per mille of rated current: the same, the constant being constant
        actual(0x60F4, I32, self._following_error)
        self.target_torque = o.add(0x6071, Entry(I16, 0, write=self._aim_torque, mappable=True))
        self.target_position = o.add(0x607A, Entry(I32, 0, write=self._aim_position, mappable=True))
        self.target_velocity = o.add(0x60FF, Entry(I32, 0, write=self._aim_velocity, mappable=True))
        most = round(1000.0 * self.world.parameters.torque_limit / self.rating.torque)
        self.max_torque = o.add(0x6072, Entry(U16, most, mappable=True))  # per mille of 6076
        turn = self.motor.counts_per_turn
        self.window = o.add(0x6065, Entry(U32, turn // 4))  # increments
        self.window_time = o.add(0x6066, Entry(U16, 100))  # ms
        self.deceleration = o.add(0x6085, Entry(U32, 100 * turn))  # increments/s², from 600 rpm to rest in 0.1 s
        self.interval = Entry(U8, 1)
        o.record(0x60C2, {1: self.interval, 2: Entry(I8, -3)})

    def _plate(self, o: Objects) -> None:
        turn = self.motor.counts_per_turn
        milliamperes = round(1000.0 * self.rating.torque / self.rating.constant)
        o.add(0x6073, Entry(U16, self.max_torque.value))
        o.add(0x6075, Entry(U32, milliamperes))
        self.rated_torque = o.add(0x6076, Entry(U32, round(1000.0 * self.rating.torque)))
        o.add(0x6080, Entry(U32, 3000))  # rpm
        o.record(0x608F, {1: Entry(U32, turn), 2: Entry(U32, 1)})
        o.record(0x6091, {1: Entry(U32, 1), 2: Entry(U32, 1)})  # what is geared lies behind the motor's own encoder
        o.record(0x6092, {1: Entry(U32, turn), 2: Entry(U32, 1)})
        o.add(0x60A8, Entry(U32, INCREMENTS))
        o.add(0x60A9, Entry(U32, INCREMENTS_PER_SECOND))

    # ---- state machine ----

    def _control(self, value: float) -> None:
        word, before = int(value), self.controlword.number
        self.controlword.value = word
        if self.drive_state is DriveState.FAULT:
            if word & FAULT_RESET and not before & FAULT_RESET:
                self._reset_fault()
            return
        if self.sto_active:
            return
        asked = command(word)
        follows = TRANSITIONS.get(self.drive_state, {}).get(asked)
        if follows is None:
            return
        stays = self.quick_stop_option.number in QUICK_STOP_STAYS
        if self.drive_state is DriveState.QUICK_STOP_ACTIVE and asked is Command.ENABLE_OPERATION and not stays:
            return
        self._go(follows)

    def _go(self, state: DriveState) -> None:
        if state is self.drive_state:
            return
        self.drive_state = state
        match state:
            case DriveState.OPERATION_ENABLED:
                self._engage()
            case DriveState.QUICK_STOP_ACTIVE:
                stays = self.quick_stop_option.number in QUICK_STOP_STAYS
                self._brake(None if stays else DriveState.SWITCH_ON_DISABLED)
            case _:
                self._release()
        self.event(self.statusword)

    def _reset_fault(self) -> None:
        if self.incurable or self.sto_active:
            self.emergency(self.error_code.number, self.error_register.number)
            return
        self.error_code.value = 0
        self.recovered()
        self._go(DriveState.SWITCH_ON_DISABLED)

    def fault(self, code: int, register: int = PROFILE, more: bytes = b"") -> None:
        """The drive's own protection acts, as 605E says: 0 torque off, else brake first."""
        if self.drive_state in (DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE):
            return
        moving = self.drive_state in (DriveState.OPERATION_ENABLED, DriveState.QUICK_STOP_ACTIVE)
        self.error_code.value = code
        self._go(DriveState.FAULT_REACTION_ACTIVE)
        self.emergency(code, register, more)
        if moving and self.fault_option.number:
            self._brake(DriveState.FAULT)
        else:
            motor = self.motor
            self.agenda.after(REACTION, lambda: self._go(DriveState.FAULT) if motor is self.motor else None)

    def sto(self, active: bool, fault: bool) -> None:
        """Safe torque off from outside: torque is gone at once, as a fault or as a mere loss of enable."""
        self.sto_active = active
        if active and fault:
            self._release()
            self.fault(STO_FAULT)
        elif active and self.drive_state not in (DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE):
            self._go(DriveState.SWITCH_ON_DISABLED)
        self.event(self.statusword)

    def on_lost(self, code: int) -> None:
        option = self.abort_option.number
        if self.drive_state not in POWERED or option not in (1, 2, 3):
            self.emergency(code, COMMUNICATION)
            return
        if option == 1:
            self.fault(code, COMMUNICATION | GENERIC)
            return
        self.emergency(code, COMMUNICATION)
        self._go(DriveState.SWITCH_ON_DISABLED if option == 2 else DriveState.QUICK_STOP_ACTIVE)

    def on_state(self) -> None:
        if self.state is not State.OPERATIONAL and self.drive_state in POWERED:
            self.on_lost(CONNECTION)

    def _status(self) -> int:
        word = self.drive_state | REMOTE | (0 if self.sto_active else VOLTAGE)
        if self.limited:
            word |= LIMIT
        if self.drive_state is DriveState.OPERATION_ENABLED and self.mode:
            word |= FOLLOWS
            if abs(self._following_error()) > self.window.number:
                word |= FOLLOWING_ERROR
        return word

    # ---- motion ----

    def _set_mode(self, value: float) -> None:
        if value not in set(Mode):
            raise Abort(AbortCode.VALUE)
        mode = Mode(int(value))
        if mode is not self.mode and not self.mode_stuck:
            motor = self.motor
            self.agenda.after(MODE_CHANGE, lambda: self._change_mode(mode) if motor is self.motor else None)

    def _change_mode(self, mode: Mode) -> None:
        self.mode = mode
        if self.drive_state is DriveState.OPERATION_ENABLED:
            self._engage()

    def _engage(self) -> None:
        """Follow the targets of the mode. A position is held where it is until a target comes."""
        self._release()
        parameters = self.world.parameters
        match self.mode:
            case Mode.CST:
                self._aim_torque(self.target_torque.number)
            case Mode.CSV:
                self._loop = VelocityLoop(parameters)
                self._aim_velocity(self.target_velocity.number)
                self._tick()
            case Mode.CSP:
                self._loop = PositionLoop(parameters, self.motor.sample().theta, self.interval.number * 1e-3)
                self._tick()

    def _release(self) -> None:
        self._loop, self._braking, self._then, self.limited, self._late = None, None, None, False, 0.0
        self._ticker.stop()
        self.motor.drive(0.0)

    def _brake(self, then: DriveState | None) -> None:
        self._release()
        slowdown = self.motor.radians_per_second(self.deceleration.number)
        self._braking = Braking(self.world.parameters, self.motor.sample().omega, slowdown)
        self._then = then
        self._tick()

    def _tick(self) -> None:
        loop = self._braking or self._loop
        assert loop is not None
        self._drive(loop.torque(self.motor.sample(), self._limit))
        self._ticker.start(PERIOD)
        if self._braking is not None and self._braking.finished and self._then is not None:
            self._go(self._then)
        elif abs(self._following_error()) > self.window.number:
            self._late += PERIOD
            if self._late * 1e3 > self.window_time.number:
                self.fault(FOLLOWING)
        else:
            self._late = 0.0

    @property
    def _limit(self) -> float:
        """N·m: 6072, and what the motor can give."""
        return min(self.max_torque.number / 1000.0 * self.rating.torque, self.world.parameters.torque_limit)

    def _drive(self, tau: float) -> None:
        limit = self._limit
        self.limited = not abs(tau) <= limit
        self.motor.drive(math.copysign(limit, tau) if self.limited else tau)

    def _aim_torque(self, value: float) -> None:
        if self.drive_state is DriveState.OPERATION_ENABLED and self.mode is Mode.CST:
            self._drive(value / 1000.0 * self.rating.torque)

    def _aim_velocity(self, value: float) -> None:
        if self._loop is not None and self.mode is Mode.CSV:
            self._loop.aim(self.motor.radians_per_second(value))

    def _aim_position(self, value: float) -> None:
        if self._loop is not None and self.mode is Mode.CSP:
            self.motor.sample()
            self._loop.aim(self.motor.angle(value))

    def _torque_actual(self) -> int:
        self.motor.sample()
        return max(-0x8000, min(0x7FFF, round(1000.0 * self.motor.tau / self.rating.torque)))

    def _following_error(self) -> int:
        if self._loop is None:
            return 0
        turns = self._loop.following_error(self.motor.sample().theta) / (2.0 * math.pi)
        return wrapped(turns * self.motor.counts_per_turn)
