"""A servo drive after CiA 402 at the twin's motor: cyclic synchronous torque, velocity and position."""

from __future__ import annotations

from collections.abc import Callable
from typing import final

from sim.wire.bus import Bus
from sim.wire.emergency import COMMUNICATION, GENERIC, PROFILE
from sim.wire.motion import SUPPORTED, Mode, Motion
from sim.wire.motor import Motor, Rating
from sim.wire.node import Node, NodeIdentity
from sim.wire.objects import I8, I16, I32, U16, U32, Abort, AbortCode, Entry, Kind, Objects
from sim.wire.pdo import OFF, PdoDefault
from sim.wire.plate import add_plate, add_settings
from sim.wire.states402 import FAULT_RESET, POWERED, TRANSITIONS, Command, DriveState, command
from sim.wire.watch import State
from sim.world import World

MODE_CHANGE = 0.002  # s from 6060 to 6061
REACTION = 0.001  # s in fault reaction at least
VOLTAGE, REMOTE, LIMIT, FOLLOWS, FOLLOWING_ERROR = 1 << 4, 1 << 9, 1 << 11, 1 << 12, 1 << 13  # statusword
FOLLOWING, STO_FAULT, CONNECTION = 0x8611, 0xFF01, 0x8100  # error codes; STO has none in the profile
QUICK_STOP_STAYS = range(5, 9)  # 605A: stay in quick stop active


@final
class ServoDrive(Node):
    """6064 in encoder increments (608F), 606C and 60FF in increments/s, 6071 and 6077 in per mille of 6076 [mN·m].

    Guarded by heartbeat consumer 1016, node guarding 100C/100D and RPDO timeouts 140x:05; what happens then says 6007
    (0 nothing, 1 fault, 2 disable voltage, 3 quick stop) while the power stage is on.
    """

    motion: Motion
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
        super().__init__(bus, node_id, NodeIdentity(0x00020192, "hdrig twin servo drive", 0x402, world.seed))

    # ---- objects ----

    def furnish(self, objects: Objects) -> None:
        """Objects of the profile for a new life of the node, as from the factory; torque is off."""
        self.motor = Motor(self.world, self.agenda)
        settings = add_settings(objects, self.motor, self.rating)
        if self._life > 1:
            self.motion.release()
        self.motion = Motion(self.agenda, self.motor, settings, self.rating.torque, lambda: self.fault(FOLLOWING))
        self.motion.release()
        self.drive_state = DriveState.SWITCH_ON_DISABLED
        self._control_objects(objects)
        self._motion_objects(objects)
        add_plate(objects, self.motor, self.rating)
        self.rated_torque = objects.find(0x6076, 0)

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

        motor, motion = self.motor, self.motion
        actual(0x6064, I32, lambda: motor.position)
        actual(0x606C, I32, lambda: motor.speed)
        actual(0x6077, I16, motion.torque_actual)
        actual(0x6078, I16, motion.torque_actual)  # per mille of rated current: the same, the constant being constant
        actual(0x60F4, I32, motion.following_error)
        motion.settings.target_torque.write = motion.aim_torque
        motion.settings.target_position.write = motion.aim_position
        motion.settings.target_velocity.write = motion.aim_velocity

    @property
    def mode(self) -> Mode:
        """6061."""
        return self.motion.mode

    @mode.setter
    def mode(self, mode: int) -> None:
        self.motion.mode = Mode(mode)

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
                self.motion.follow()
            case DriveState.QUICK_STOP_ACTIVE:
                self.motion.brake(self._quick_stopped)
            case _:
                self.motion.release()
        self.event(self.statusword)

    def _quick_stopped(self) -> None:
        if self.quick_stop_option.number not in QUICK_STOP_STAYS:
            self._go(DriveState.SWITCH_ON_DISABLED)

    def _reset_fault(self) -> None:
        if self.incurable or self.sto_active:
            self.errors.report(self.error_code.number, self.errors.register.number)
            return
        self.error_code.value = 0
        self.errors.recovered()
        self._go(DriveState.SWITCH_ON_DISABLED)

    def fault(self, code: int, register: int = PROFILE, more: bytes = b"") -> None:
        """The drive's own protection acts, as 605E says: 0 torque off, else brake first."""
        if self.drive_state in (DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE):
            return
        moving = self.drive_state in (DriveState.OPERATION_ENABLED, DriveState.QUICK_STOP_ACTIVE)
        self.error_code.value = code
        self._go(DriveState.FAULT_REACTION_ACTIVE)
        self.errors.report(code, register, more)
        if moving and self.fault_option.number:
            self.motion.brake(lambda: self._go(DriveState.FAULT))
        else:
            life = self._life
            self.agenda.after(REACTION, lambda: self._go(DriveState.FAULT) if life == self._life else None)

    def sto(self, active: bool, fault: bool) -> None:
        """Safe torque off from outside: torque is gone at once, as a fault or as a mere loss of enable."""
        self.sto_active = active
        if active and fault:
            self.motion.release()
            self.fault(STO_FAULT)
        elif active and self.drive_state not in (DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE):
            self._go(DriveState.SWITCH_ON_DISABLED)
        self.event(self.statusword)

    def on_lost(self, code: int) -> None:
        """The host is lost, emergency `code`: 6007 says what becomes of a drive under power."""
        option = self.abort_option.number
        if self.drive_state not in POWERED or option not in (1, 2, 3):
            self.errors.report(code, COMMUNICATION)
            return
        if option == 1:
            self.fault(code, COMMUNICATION | GENERIC)
            return
        self.errors.report(code, COMMUNICATION)
        self._go(DriveState.SWITCH_ON_DISABLED if option == 2 else DriveState.QUICK_STOP_ACTIVE)

    def on_state(self) -> None:
        """Leaving OPERATIONAL under power is a lost connection."""
        if self.state is not State.OPERATIONAL and self.drive_state in POWERED:
            self.on_lost(CONNECTION)

    def _status(self) -> int:
        word = self.drive_state | REMOTE | (0 if self.sto_active else VOLTAGE)
        if self.motion.limited:
            word |= LIMIT
        if self.drive_state is DriveState.OPERATION_ENABLED and self.mode is not Mode.NONE:
            word |= FOLLOWS
            if self.motion.too_far():
                word |= FOLLOWING_ERROR
        return word

    # ---- modes ----

    def _set_mode(self, value: float) -> None:
        if value not in set(Mode):
            raise Abort(AbortCode.VALUE)
        mode, motion = Mode(int(value)), self.motion
        if mode is not motion.mode and not self.mode_stuck:
            self.agenda.after(MODE_CHANGE, lambda: motion.change(mode) if motion is self.motion else None)
