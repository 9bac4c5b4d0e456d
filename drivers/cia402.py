"""CiA 402 servo drive over CANopen: cyclic synchronous torque, the host closing the loop, or velocity or position
[cia402]

Commands are sent at once (RPDO type 255), readings are latched on SYNC.
"""

from __future__ import annotations

import contextlib
import struct
from typing import ClassVar

from drivers import watchdog402
from drivers.limits402 import set_limits
from drivers.mapping import Mapped
from drivers.modes402 import UNDECIDED, choose, rest_all, shown, shows
from drivers.node import Node
from drivers.on_can import OnCan
from drivers.pdo import Inputs, Outputs
from drivers.profile402 import DISABLE, ENABLE, SHUTDOWN, SWITCH_ON, speed_unit, state_of
from drivers.scales402 import compare_scales
from drivers.silence import UNANSWERED
from drivers.states402 import confirmed_off, error_of, reset, walk
from drivers.targets402 import PERMILLE, TARGETS, Scale
from drivers.unwrap import Unwrapped
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.clock import NEVER, is_never
from rig.core.devices import DriveReading, Identity, Watchdog
from rig.core.errors import NotReady
from rig.core.sample import NAN, Mode, Position, Setpoint, Torque, Velocity
from rig.core.units import TURN

PROFILE = 402
VOLTAGE = 1 << 4  # of the statusword: high voltage is applied to the power stage
WATCHDOG = 0.1  # s, where the bench file says none
LONGER = 1.5  # times what the guard allows: the host stops first and says why
STATUS = (Mapped(0x6041, 0, 16, "H"), Mapped(0x6061, 0, 8, "b"), Mapped(0x6077, 0, 16, "h"))
SHOWN = STATUS[1:2]
TELLS = {0x6061: "mode", 0x6077: "torque", 0x6064: "position"}
MOTION = (Mapped(0x6064, 0, 32, "i"),)
CHOSEN = (Mapped(0x6060, 0, 8, "b"),)  # in the fixed RPDOs of some drives: told what it has already
NOTHING = (0, 0)  # for the targets of other modes, in the fixed RPDOs of some drives
LIMITED, LAGS = 1 << 11, 1 << 13  # of the statusword: internal limit, following error (other modes: no meaning)
BEHIND = {Mode.TORQUE: LIMITED, Mode.VELOCITY: LIMITED, Mode.POSITION: LIMITED | LAGS}
KINDS: dict[type[Setpoint], Mode] = {Torque: Mode.TORQUE, Velocity: Mode.VELOCITY, Position: Mode.POSITION}


class Cia402(OnCan):
    """A drive at `node` on `bus`; the numbers of its object dictionary have to agree with the bench file's."""

    keys: ClassVar[tuple[str, ...]] = ("bus", "node", "direction", "watchdog", "torque_constant", "rated_step")
    answers: ClassVar[tuple[int, ...]] = (5, 4)  # data bytes of its frames after a SYNC
    commands: ClassVar[tuple[int, ...]] = (4,)  # of what it is sent a tick; 6 in velocity and position mode

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.bus = wiring.bus(place)
        self.node = Node(self.bus, place.need("node"), "drive")
        self.remarks = self.node.remarks
        self.place = place
        self.watchdog = Watchdog()
        self._armed = 0  # the object that sets it
        self.mode = Mode.TORQUE
        self._inputs, self._outputs = Inputs(self.node, place.period), Outputs(self.node)
        self._direction = place.options.get("direction", 1)
        self._rated = place.torque_rated
        self._step = TURN / place.counts_per_turn
        self._angle = Unwrapped.of(place, 1 << 32)
        self._enabled = self._connected = False
        self._left = False  # alone, after a stop that it did not confirm
        self._last = DriveReading(NEVER, NAN, 0, NAN)
        self._scale = Scale(place)
        self._written = NEVER  # s, when
        self._carried = 0.0  # the setpoint sent last: the drive goes by it until another comes

    # ---- connecting ----

    def connect(self) -> Identity:
        """Identify, compare scales, configure, start. Nothing is energised: the drive is told to disable first."""
        self.node.open()
        self._left = self.bus.mute = False
        identity = self.node.identify(PROFILE)
        self.node.pause()
        self.node.sdo.put(0x6040, 0, struct.pack("<H", DISABLE))
        compare_scales(self.node, self.place)
        self._configure()
        self.node.start()
        self._connected = True
        self.node.forget()
        self._first_reading()
        if self.trouble:  # in fault already: with its code in words
            self.trouble = f"{self.trouble}: {error_of(self.node)}"
        return identity

    def _configure(self) -> None:
        for told in (*STATUS[1:], *MOTION):
            if self.node.sdo.lacks(told.at):  # small nodes take it into a PDO all the same, and tell zeros
                raise NotReady(f"{self.node.who} does not tell its {TELLS[told.at]} ({told.at:04X}h)")
        self._inputs.arrange((STATUS, MOTION), optional=SHOWN)
        self.node.produce_heartbeat()
        set_limits(self.node, self.place)
        self._take_mode(Mode.TORQUE)
        self._arm()
        self._disarm()

    def _take_mode(self, mode: Mode) -> None:
        """Targets of `mode` in RPDO 1, and in 6060h. The node is pre-operational."""
        target = TARGETS[mode]
        if mode is Mode.VELOCITY:
            code = self.node.sdo.read_uint(0x60A9, default=0)
            unit = speed_unit(code, self.place.counts_per_turn)
            if unit is None:
                raise NotReady(f"{self.node.who} tells speeds in a unit not known here (60A9h = {code:08X}h)")
            self._scale.speed_unit = unit
        choose(self.node, mode)
        others = [other.object for other in TARGETS.values() if other is not target]
        self._outputs.arrange(target.mapped, [*CHOSEN, *others])
        self.mode = mode

    def _arm(self) -> None:
        seconds = self.place.options.get("watchdog", max(WATCHDOG, LONGER * self.place.stale))
        self.watchdog, self._armed = watchdog402.arm(self.node, round(1000 * seconds))

    def _disarm(self) -> None:
        watchdog402.disarm(self.node, self._armed)

    def _first_reading(self) -> None:
        self.bus.frames.clear()
        self._inputs.first(0.5)
        self.read()

    @property
    def silent(self) -> str:
        """Which of its frames, where it tells all there is in several."""
        return self._inputs.silent

    # ---- states ----

    def enable(self, mode: Mode = Mode.TORQUE) -> None:
        """Walk to OPERATION ENABLED at rest, the watchdog armed. Raises NotReady: where it stuck."""
        if not self._connected:
            raise NotReady("the drive is not connected")
        if self._left:  # off by now, or nobody would have got here
            self.node.start()
            self._take_up()
        if mode is not self.mode:
            self._change(mode)
        self._scale.position = self._direction * self.node.sdo.read_int(0x6064) * self._step
        walk(self.node, self._hold, SHUTDOWN, "ready to switch on")
        walk(self.node, self._hold, SWITCH_ON, "switched on")
        rest_all(self.node)
        if not (confirmed := shows(self.node, mode)) and shown(self.node) != UNDECIDED:
            raise self._other_mode()
        self._arm()
        walk(self.node, self._hold, ENABLE, "operation enabled")
        if not confirmed and not shows(self.node, mode):
            raise self._other_mode()
        self._angle.forget()
        self._first_reading()  # or a statusword from before would pass for a drive that fell out by itself
        self._written = self.bus.clock.now()
        self._carried = self._scale.position if mode is Mode.POSITION else 0.0
        self._enabled = True

    def _change(self, mode: Mode) -> None:
        before = self.mode
        self.node.pause()
        try:
            self._take_mode(mode)
        except NotReady:
            with contextlib.suppress(NotReady):  # the reason for the first is the one to tell
                self._take_mode(before)
            raise
        finally:
            self.node.start()

    def _other_mode(self) -> NotReady:
        self.halt()
        told, wanted = shown(self.node), TARGETS[self.mode].number
        return NotReady(f"{self.node.who} did not take {self.mode} mode: 6061h is {told}, expected {wanted}")

    def _command(self, controlword: int, raw: int) -> bool:
        return self._outputs.send(controlword, raw, TARGETS[self.mode].number, *NOTHING)

    def _hold(self, controlword: int) -> bool:
        """A controlword with nothing asked for: no torque, rest, the angle it has."""
        return self._command(controlword, self._scale.rest(self.mode))

    # ---- in a run ----

    def read(self) -> DriveReading:
        """The newest PDOs; never waits. A frame of another length than mapped is a fault, not a number."""
        self.bus.drain()
        latched = self._inputs.take()
        if self._inputs.wrong:
            self._blame(self._inputs.wrong)
        if is_never(latched):
            return self._told(self._last)
        word, mode, permille, position = self._inputs.values
        self.voltage = bool(int(word) & VOLTAGE)
        self._judge(int(word), mode)
        flags = int(Flag.SATURATED_DRIVE) if self._scale.clipped or int(word) & BEHIND[self.mode] else 0
        if latched != self._last.t:
            jump = self._angle.step(int(position))
            if jump:
                flags |= Flag.EPOCH
                self._blame(f"the motor's count jumped by {jump} between two readings: reset, or a count lost")
        counts = self._direction * (self._angle.counts or 0)
        tau = self._direction * permille / PERMILLE * self._rated
        self._last = DriveReading(latched, counts * self._step, counts, tau, flags)
        return self._told(self._last)

    def _judge(self, statusword: int, mode: float) -> None:
        state = state_of(statusword)
        if state.startswith("fault"):
            self._blame(self.node.emergency or f"{self.node.who} is in {state}")
        elif self._enabled and state != "operation enabled":
            self._blame(f"{self.node.who} left operation by itself: {state} (safe torque off?)")
        elif self._enabled and mode == mode and mode != TARGETS[self.mode].number:  # NaN: it does not tell
            self._blame(f"{self.node.who} left {self.mode} mode: 6061h is {mode:g}")
        if self._enabled and (told := self.node.trouble(self.bus.clock.now())):
            self._blame(told)

    def _told(self, reading: DriveReading) -> DriveReading:
        return reading._replace(fault=self.trouble or self.bus.dead) if self.trouble or self.bus.dead else reading

    def _blame(self, why: str) -> None:
        self.trouble = self.trouble or why  # the first cause stays

    def write(self, setpoint: Setpoint) -> float:
        """What fits the frame, within the limits; the one before where this could not be sent. Nothing is sent unless
        it is enabled for that kind of setpoint.
        """
        if not self._enabled or KINDS[type(setpoint)] is not self.mode:
            return NAN if KINDS[type(setpoint)] is Mode.POSITION else 0.0
        if self.bus.synced - self._last.t > UNANSWERED * self.place.period:
            return self._carried  # a drive that is not heard may not hear: nothing is queued that could reach it later
        now = self.bus.clock.now()
        raw, carried = self._scale.within(self.mode, setpoint[0], now - self._written)
        self._written = now
        if self._command(ENABLE, raw):
            self._carried = carried
        return self._carried

    # ---- off ----

    def cut(self) -> None:
        """Disable voltage at once. Never raises."""
        self._enabled = False
        if self._connected:
            self.bus.discard()
            for _ in range(2):  # one may meet a full queue
                self._hold(DISABLE)

    def halt(self) -> bool:
        """Disable voltage at once; True when a statusword confirms that nothing is energised. Never raises."""
        self.cut()
        if not self._connected:
            return False
        if not confirmed_off(self.node, self._inputs, self._hold):
            self._leave_alone()
            return False
        with contextlib.suppress(NotReady):  # who cannot be disarmed trips by its watchdog: it is without torque
            self._disarm()
        return True

    def _leave_alone(self) -> None:
        """It may be energised, and what we say does not reach it: its own watchdog is the last that can take the torque
        off, and stays armed. No heartbeat feeds it, and an NMT stop is a lost connection too."""
        self._left = self.bus.mute = True
        self.node.stop()

    def _take_up(self) -> None:
        """It says that it is off: it is talked to again. Not before, or we would feed the watchdog of a drive that may
        be energised. Raises NotReady."""
        if self._left:
            self._disarm()
            self._left = self.bus.mute = False

    def reset_fault(self) -> None:
        """The rising edge of bit 7, then disabled. Raises NotReady when the fault stays."""
        if not self._connected:
            raise NotReady("the drive is not connected")
        if self._left or self.node.aside(self.bus.clock.now()):
            self.node.revive()
            self.node.start()
        reset(self.node, self._hold)
        self._take_up()
        self.node.revive()
        self._inputs.wrong = ""
        self.trouble = ""
        self._first_reading()  # or the last statusword, still a fault, would be read again
