"""ODrive motor controller over CANSimple, torque control: the host closes the loop      [odrive]

Nothing is synchronous here: readings are stamped when they arrive. What an axis tells at least every other tick is
listened to; anything else it is asked for by a remote frame, every tick. There are no encoder counts on the wire:
position is a filtered estimate in f32, exact to 1e-6 turn up to 16 turns from zero, coarser by two with each doubling.
"""

from __future__ import annotations

import contextlib
import math
import struct
from typing import ClassVar

from drivers import cansimple as cs
from drivers.axis import Axis
from drivers.on_can import OnCan
from drivers.silence import UNANSWERED, missing
from drivers.unwrap import LATE
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.clock import NEVER
from rig.core.devices import DriveReading, Identity, Watchdog, torque_only
from rig.core.errors import NotReady
from rig.core.sample import NAN, Mode, Setpoint
from rig.core.units import TURN

STEP_PATIENCE = 2.0  # s for a change of state, seen in a heartbeat
ANSWER = 0.1  # s for the first readings
COUNTED = 0.03  # s over which unasked readings are counted
FEED = 0.01  # s between commands while it changes state: they feed its watchdog
CONFIRM = 0.5  # s for a heartbeat that says it is off; the frame that takes the torque off has long been sent
SPEED_MARGIN = 1.1  # the axis limits speed by itself a little above the guard's limit: the guard comes first


class ODrive(OnCan):
    """An axis of `node` on `bus`.

    Options: `torque_constant` N·m/A, needed where the firmware (up to 0.5) tells a current and no torque; `watchdog` s,
    only where it was set up in the axis with the maker's tool: CANSimple can neither set it up nor read it back.
    """

    keys: ClassVar[tuple[str, ...]] = ("bus", "node", "direction", "watchdog", "torque_constant")
    answers: ClassVar[tuple[int, ...]] = (8, 8)  # data bytes of the frames read in a tick
    commands: ClassVar[tuple[int, ...]] = (4, 0, 0)  # torque, and two remote frames that ask for readings

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.bus = wiring.bus(place, cs.PROTOCOL)
        self.axis = Axis(self.bus, place.need("node"), "drive")
        self.place = place
        self.watchdog = Watchdog()
        self._direction = place.options.get("direction", 1)
        self._constant = place.options.get("torque_constant")
        self._declared = place.options.get("watchdog")  # s
        self._most = max(LATE * place.speed_limit * place.period / TURN, 1 / place.counts_per_turn)  # turns
        self._motion, self._effort = self.axis.id(cs.ESTIMATES), self.axis.id(cs.TORQUES)
        self._gain = 1.0  # N·m per unit of the effort's reading
        self._turns = NAN
        self._enabled = self._connected = False
        self._saturated = 0
        self._carried = 0.0  # N·m, sent last: the axis goes by it until another comes
        self._looked = NEVER  # s, when readings were last looked for
        self._last = DriveReading(NEVER, NAN, 0, NAN)

    def connect(self) -> Identity:
        """Listen, identify, have it idle, see how it tells its readings. Energises nothing. Raises NotReady."""
        identity = self.axis.open()
        self.axis.request(cs.IDLE)
        self._choose_readings()
        self._limit()
        self._connected = True
        self.watchdog = self._watched()
        self._first_reading()
        return identity

    def _choose_readings(self) -> None:
        if not self.axis.tells_torque:
            if not self._constant:
                raise NotReady(
                    f"{self.axis.who} has a firmware that tells no torque (0x1C came with 0.6), only a current: "
                    f"{self.place.where} needs torque_constant in N·m/A"
                )
            self._effort, self._gain = self.axis.id(cs.IQ), self._constant
        wanted = (self._motion, self._effort)
        before = [self._count(i) for i in wanted]
        self.bus.wait(COUNTED, lambda: False)
        enough = COUNTED / self.place.period / 2
        self.bus.requests = [i for i, n in zip(wanted, before, strict=True) if self._count(i) - n < enough]

    def _count(self, identifier: int) -> int:
        frame = self.bus.frames.get(identifier)
        return frame.number if frame else 0

    def _limit(self) -> None:
        """The axis's own limits, where a torque constant says what current the torque limit is."""
        if self._constant:
            turns = SPEED_MARGIN * self.place.speed_limit / TURN
            self.axis.send(cs.SET_LIMITS, cs.encode_limits(turns, self.place.torque_limit / self._constant))

    def _watched(self) -> Watchdog:
        """What the bench file declares of the watchdog, and whether it is seen to expire while the axis is idle."""
        if self._declared is None:
            return Watchdog()
        self.axis.forgives = self.axis.expired  # nobody talks to an idle axis: that is no fault
        told = f"watchdog of the axis, {self._declared * 1e3:g} ms"
        if self.axis.error:
            return Watchdog(f"{told}, declared; not tried, which proves nothing")
        self.axis.clear()
        seen = self.bus.wait(1.5 * self._declared + 2 * self.axis.interval, lambda: self.axis.expired_now)
        if seen:
            return Watchdog(f"{told}, seen to expire", is_proven=True)
        return Watchdog(f"{told}, declared; it did not expire while idle, which proves nothing")

    def _first_reading(self) -> None:
        for identifier in (self._motion, self._effort):
            self.bus.frames.pop(identifier, None)
        self.bus.latch()
        if not self.bus.wait(ANSWER, lambda: {self._motion, self._effort} <= self.bus.frames.keys()):
            silent = [_message(i) for i in (self._motion, self._effort) if i not in self.bus.frames]
            told = " and ".join(silent)
            raise NotReady(f"{self.axis.who} does not tell {told}, neither unasked nor asked by a remote frame")
        self._turns = NAN
        self.read()

    @property
    def silent(self) -> str:
        """Estimates or torques, where only one of them comes."""
        motion, effort = self.bus.frames.get(self._motion), self.bus.frames.get(self._effort)
        if motion is None or effort is None:
            return ""
        heard = {_message(self._motion): motion.arrived, _message(self._effort): effort.arrived}
        told = missing(heard, self.place.period)
        return f"of {self.axis.who} {told}" if told else ""

    def enable(self, mode: Mode = Mode.TORQUE) -> None:
        """Torque control with zero torque, closed loop. Raises NotReady: where it stuck, with its errors in words."""
        if not self._connected:
            raise NotReady("the drive is not connected")
        torque_only(self.axis.who, mode)
        self.axis.fresh()
        if self.axis.error:
            raise NotReady(f"{self.axis.error}; reset it first")
        if self.axis.any_error:  # its watchdog, while nobody talked to it
            self.axis.clear()
        self.axis.send(cs.SET_MODE, cs.encode_mode(cs.TORQUE_CONTROL, cs.PASSTHROUGH))
        self.axis.send(cs.SET_TORQUE, cs.encode_torque(0.0))
        self.axis.request(cs.CLOSED_LOOP)
        self._closed_loop()
        self.axis.forgives = 0
        self.trouble = ""
        self._first_reading()
        self._carried = 0.0
        self._enabled = True

    def _closed_loop(self) -> None:
        until = self.bus.clock.now() + STEP_PATIENCE
        while self.axis.state != cs.CLOSED_LOOP:
            if self.bus.dead or self.bus.clock.now() > until or self.axis.error:
                told = f"{self.axis.who} stays in '{self.axis.state_text()}', expected closed-loop control"
                why = self.axis.error or "is the motor calibrated?"
                self.halt()
                raise NotReady(f"{told} within {STEP_PATIENCE:g} s: {why}")
            if self.axis.expired_now:  # the machine was away for that long
                self.axis.send(cs.CLEAR, b"\0")
                self.axis.request(cs.CLOSED_LOOP)
            self.axis.send(cs.SET_TORQUE, cs.encode_torque(0.0))
            self.bus.wait(FEED, lambda: self.axis.state == cs.CLOSED_LOOP)

    def read(self) -> DriveReading:
        """The newest estimates; never waits. What is no number, or of another length, is a fault."""
        self.bus.drain()
        self._looked = self.bus.clock.now()
        self._judge()
        motion, effort = self.bus.frames.get(self._motion), self.bus.frames.get(self._effort)
        if motion is None or effort is None:
            return self._told(self._last)
        if len(motion.data) != 8 or len(effort.data) != 8:
            sizes = f"{len(motion.data)} and {len(effort.data)}"
            self._blame(f"{self.axis.who} sends readings of {sizes} bytes, expected 8 and 8")
            return self._told(self._last)
        t = min(motion.arrived, effort.arrived)  # the older of the two: neither may fall silent alone
        flags = self._saturated
        if t != self._last.t:
            flags |= self._step(cs.decode_pair(motion.data)[0])
        turns = self._direction * self._turns
        counts = round(turns * self.place.counts_per_turn) if math.isfinite(turns) else 0  # the estimate, in counts
        tau = self._direction * self._gain * cs.decode_pair(effort.data)[1]
        self._last = DriveReading(t, turns * TURN, counts, tau, flags)
        return self._told(self._last)

    def _step(self, turns: float) -> int:
        """Take a position; the flag of a jump."""
        moved, self._turns = turns - self._turns, turns
        if not math.isfinite(turns):
            self._blame(f"{self.axis.who} tells a position of {turns} turns")
        if abs(moved) > self._most:  # False for the first one, which moved from nowhere
            self._blame(f"the motor's position jumped by {moved:.4f} turns between two readings: reset, or rebooted")
            return int(Flag.EPOCH)
        return 0

    def _judge(self) -> None:
        if self.axis.error:
            self._blame(self.axis.error)
        elif self._enabled and self.axis.state != cs.CLOSED_LOOP:
            self._blame(f"{self.axis.who} left closed-loop control by itself: {self.axis.state_text()}")
        elif self._enabled and self.axis.overdue():
            self._blame(self.axis.silence())

    def _told(self, reading: DriveReading) -> DriveReading:
        trouble = self.trouble or self.bus.dead
        return reading._replace(fault=trouble) if trouble else reading

    def _blame(self, why: str) -> None:
        self.trouble = self.trouble or why  # the first cause stays

    def write(self, setpoint: Setpoint) -> float:
        """The torque within the limit, as f32 carries it [N·m]; the one before where this one could not be sent, zero
        unless enabled.
        """
        if not self._enabled:
            return 0.0
        limit = self.place.torque_limit
        asked = setpoint[0] if math.isfinite(setpoint[0]) else 0.0
        tau = min(max(asked, -limit), limit)
        self._saturated = int(Flag.SATURATED_DRIVE) if abs(asked) > limit else 0
        if self._looked - self._last.t > UNANSWERED * self.place.period:
            return self._carried  # a drive that is not heard may not hear: nothing is queued that could reach it later
        data = cs.encode_torque(self._direction * tau)
        if self.axis.send(cs.SET_TORQUE, data):
            self._carried = self._direction * float(struct.unpack("<f", data)[0])
        return self._carried

    def cut(self) -> None:
        """Idle and zero torque at once. Never raises."""
        self._enabled = False
        if self._connected:
            self.bus.discard()
            for _ in range(2):  # one may meet a full queue
                self.axis.request(cs.IDLE)
                self.axis.send(cs.SET_TORQUE, cs.encode_torque(0.0))

    def halt(self) -> bool:
        """Idle and zero torque at once; True when a heartbeat says that it left closed loop. Never raises."""
        self.cut()
        if not self._connected:
            return False
        off = self._confirmed_off()
        self.axis.forgives = self.axis.expired if self._declared is not None else 0
        return off

    def _confirmed_off(self) -> bool:
        until = self.bus.clock.now() + CONFIRM
        while self.bus.clock.now() < until and not self.bus.dead:
            with contextlib.suppress(NotReady):
                self.axis.fresh()
                if self.axis.state != cs.CLOSED_LOOP:
                    return True
            self.axis.request(cs.IDLE)
        return False

    def reset_fault(self) -> None:
        """Clear its errors; it stays idle. Raises NotReady when they come back."""
        if not self._connected:
            raise NotReady("the drive is not connected")
        self.axis.request(cs.IDLE)
        self.axis.clear()
        if self.axis.error:
            raise NotReady(f"{self.axis.error}, also after a reset")
        self.trouble = ""
        self._first_reading()


def _message(identifier: int) -> str:
    """What a message is, with its number in the maker's document."""
    command = identifier & 0x1F
    names = {cs.ESTIMATES: "its position", cs.TORQUES: "its torque", cs.IQ: "its current"}
    return f"{names[command]} (0x{command:02X})"
