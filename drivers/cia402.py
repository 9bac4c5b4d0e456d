"""CiA 402 servo drive over CANopen, torque mode (CST): the host closes the loop      [cia402]

Its state machine is walked here, one transition at a time. canopen's own helper is not used: its `reset_from_fault`
goes on to OPERATION ENABLED. Commands are sent at once (RPDO type 255), readings are latched on SYNC.
"""

from __future__ import annotations

import contextlib
import math
import struct
from typing import ClassVar

from drivers.node import Mapped, Node, emergency_text
from drivers.unwrap import Unwrapped
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.devices import Drive, DriveReading, Identity
from rig.core.errors import NotReady
from rig.core.sample import NAN, Setpoint

PROFILE = 402
TORQUE_MODE = 10  # CST in 6060h
SUPPORTED = 1 << 9  # of 6502h: CST
DISABLE, SHUTDOWN, SWITCH_ON, ENABLE, RESET = 0x00, 0x06, 0x07, 0x0F, 0x80  # controlwords
TURN = 2 * math.pi
NEVER = -1e9  # s, a latch time older than any
STEP_PATIENCE = 1.0  # s for one transition: brakes and precharge take their time
UNANSWERED = 2.5  # periods without an answer: one frame may be lost, two may not
CONFIRM = 0.2  # s for the drive to say that it is off; the frame that takes the torque off has long been sent
PERMILLE = 1000.0
SCALE_TOLERANCE = 0.02  # a rated torque that differs by more is another scale, not rounding
LATE = 50.0  # times the fastest motion between two frames: a step beyond is no motion
COMMAND = (Mapped(0x6040, 0, 16), Mapped(0x6071, 0, 16))
STATUS = (Mapped(0x6041, 0, 16), Mapped(0x6061, 0, 8), Mapped(0x6077, 0, 16))
MOTION = (Mapped(0x6064, 0, 32),)


def state_of(statusword: int) -> str:
    """The state a statusword tells      [cia402, 6.3]"""
    if statusword & 0x4F == 0x40:
        return "switch on disabled"
    match statusword & 0x6F:
        case 0x21:
            return "ready to switch on"
        case 0x23:
            return "switched on"
        case 0x27:
            return "operation enabled"
        case 0x07:
            return "quick stop active"
    match statusword & 0x4F:
        case 0x0F:
            return "fault reaction active"
        case 0x08:
            return "fault"
        case 0x00:
            return "not ready to switch on"
    return f"no state of the standard (statusword {statusword:04X}h)"


def decode_status(data: bytes) -> tuple[int, int, int]:
    """TPDO 1 (6041h u16, 6061h i8, 6077h i16) to statusword, mode and torque in per mille of the rated one."""
    status, mode, torque = struct.unpack("<Hbh", data)
    return status, mode, torque


def encode_command(controlword: int, permille: int) -> bytes:
    """RPDO 1: 6040h u16, 6071h i16 in per mille of the rated torque."""
    return struct.pack("<Hh", controlword, permille)


class Cia402(Drive):
    """A drive at `node` on `bus`; the numbers of its object dictionary have to agree with the bench file's."""

    name = "drive"
    answers: ClassVar[tuple[int, ...]] = (5, 4)  # data bytes of its frames after a SYNC
    commands: ClassVar[tuple[int, ...]] = (4,)  # of what it is sent a tick

    def __init__(self, wiring: Wiring, place: Place) -> None:
        self.bus = wiring.bus(place)
        self.node = Node(self.bus, place.need("node"), "drive")
        self.place = place
        self.guarded = ""  # what stops the drive when this program dies, in words
        self._direction = place.options.get("direction", 1)
        self._rated = place.torque_rated
        self._step = TURN / place.counts_per_turn
        fastest = place.speed_limit * place.period / self._step
        self._angle = Unwrapped(1 << 32, max(int(LATE * fastest), 1))
        self._enabled = self._connected = False
        self._trouble = ""
        self._last = DriveReading(NEVER, NAN, 0, NAN)
        self._saturated = 0

    @property
    def _identifiers(self) -> tuple[int, int, int]:
        return 0x200 + self.node.number, 0x180 + self.node.number, 0x280 + self.node.number

    def connect(self) -> Identity:
        """Identify, compare scales, configure, start. Nothing is energised: the drive is told to disable first."""
        self.node.open()
        identity = self.node.identify(PROFILE)
        self.node.pause()
        self.node.put(0x6040, 0, struct.pack("<H", DISABLE))
        self._compare_scales()
        self._configure()
        self.node.start()
        self._connected = True
        self.node.forget()
        self._first_reading()
        return identity

    def _compare_scales(self) -> None:
        supported = self.node.read_uint(0x6502, default=SUPPORTED)
        if not supported & SUPPORTED:
            raise NotReady(f"{self.node.who} does not offer cyclic torque mode (6502h = {supported:#x}, bit 9 is 0)")
        rated = self.node.read_uint(0x6076, default=round(self._rated * 1000)) / 1000
        if abs(rated / self._rated - 1) > SCALE_TOLERANCE:
            raise NotReady(
                f"{self.node.who} says its rated torque is {rated:g} N·m (6076h), motor.torque_rated in the bench file "
                f"is {self._rated:g} N·m: every torque would be off by a factor of {rated / self._rated:.4g}"
            )
        increments, turns = (self.node.read_uint(0x608F, sub, default=0) for sub in (1, 2))
        if increments > 1 and turns and abs(increments / turns - self.place.counts_per_turn) > 0.5:
            raise NotReady(
                f"{self.node.who} counts {increments / turns:g} per turn (608Fh), motor.counts_per_turn in the bench "
                f"file is {self.place.counts_per_turn}"
            )
        motor, shaft = (self.node.read_uint(0x6091, sub, default=1) for sub in (1, 2))
        if motor != shaft:
            raise NotReady(f"{self.node.who} has a gear of {motor}:{shaft} of its own (6091h), expected 1:1")

    def _configure(self) -> None:
        command, status, motion = self._identifiers
        for unused in (0x1401, 0x1402, 0x1403, 0x1802, 0x1803):
            self.node.switch_off_pdo(unused)
        self.node.map_pdo(0x1400, command, 255, COMMAND)
        self.node.map_pdo(0x1800, status, 1, STATUS)
        self.node.map_pdo(0x1801, motion, 1, MOTION)
        self.node.produce_heartbeat()
        limit = min(round(self.place.torque_limit / self._rated * PERMILLE), 0xFFFF)
        self.node.write_if_there(0x6072, 0, struct.pack("<H", limit))
        for code in (0x605A, 0x605C, 0x605E):  # quick stop, disable operation, fault reaction: drive function off
            self.node.write_if_there(code, 0, struct.pack("<h", 0))
        self.node.put(0x6071, 0, struct.pack("<h", 0))
        self.node.write(0x6060, 0, struct.pack("<b", TORQUE_MODE))
        self.guarded = self._arm()
        self._disarm()

    def _arm(self) -> str:
        """Have the drive stop by itself when this host falls silent; by what, in words. "" when it cannot."""
        limit = round(1000 * self.place.options.get("watchdog", 0.1))
        host = self.bus.host_node
        if host and self.node.write_if_there(0x1016, 1, struct.pack("<I", host << 16 | limit)):
            return f"heartbeat consumer of the drive, {limit} ms, set and read back"
        if self.node.write_if_there(0x1400, 5, struct.pack("<H", limit)):
            return f"RPDO timeout of the drive, {limit} ms, set and read back"
        return ""

    def _disarm(self) -> None:
        """Between runs nobody talks to the drive, and that is no fault."""
        if self.guarded.startswith("heartbeat"):
            self.node.put(0x1016, 1, struct.pack("<I", 0))
        elif self.guarded:
            self.node.put(0x1400, 5, struct.pack("<H", 0))

    def _first_reading(self) -> None:
        status, motion = self._identifiers[1:]
        self.bus.frames.clear()
        self.bus.sync()
        if not self.bus.wait(0.5, lambda: status in self.bus.frames and motion in self.bus.frames):
            raise NotReady(f"{self.node.who} sent no PDOs after a SYNC: is anything else mapped or filtered?")
        self.read()

    def close(self) -> None:
        """Torque off, then off the bus."""
        if self._connected:
            self.halt()
        self._connected = False
        self.bus.close()

    def enable(self) -> None:
        """Walk to OPERATION ENABLED with zero torque, the watchdog armed. Raises NotReady: where it stuck."""
        if not self._connected:
            raise NotReady("the drive is not connected")
        self.read()
        if trouble := self._trouble or self.node.trouble(self.bus.clock.now()):
            raise NotReady(trouble)
        self._walk(SHUTDOWN, "ready to switch on")
        self._walk(SWITCH_ON, "switched on")
        mode = self.node.read_int(0x6061)
        if mode != TORQUE_MODE:
            raise NotReady(f"{self.node.who} did not take torque mode: 6061h is {mode}, expected {TORQUE_MODE}")
        self._arm()
        self._walk(ENABLE, "operation enabled")
        self._angle.forget()
        self._first_reading()  # or a statusword from before would pass for a drive that fell out by itself
        self._enabled = True

    def _walk(self, controlword: int, wanted: str) -> None:
        self.bus.send(self._identifiers[0], encode_command(controlword, 0))
        until = self.bus.clock.now() + STEP_PATIENCE
        while (state := state_of(self.node.read_uint(0x6041))) != wanted:
            if state.startswith("fault"):
                raise NotReady(f"{self.node.who} is in {state}: {self._error()}")
            if self.bus.clock.now() > until:
                raise NotReady(f"{self.node.who} stays in '{state}', expected '{wanted}' within {STEP_PATIENCE:g} s")
            self.bus.send(self._identifiers[0], encode_command(controlword, 0))

    def _error(self) -> str:
        code = self.node.read_uint(0x603F, default=0)
        return self.node.emergency or f"error {code:04X}h, {emergency_text(code)}"

    def read(self) -> DriveReading:
        """The newest PDOs; never waits. A frame of another length than mapped is a fault, not a number."""
        self.bus.drain()
        status, motion = (self.bus.frames.get(i) for i in self._identifiers[1:])
        if status is None or motion is None:
            return self._last
        if len(status.data) != 5 or len(motion.data) != 4:
            self._blame(
                f"{self.node.who} sends PDOs of {len(status.data)} and {len(motion.data)} bytes, expected 5 and 4"
            )
            return self._told(self._last)
        word, mode, permille = decode_status(status.data)
        self._judge(word, mode)
        flags = self._saturated | (Flag.SATURATED_DRIVE if word & 1 << 11 else 0)
        latched = min(status.latched, motion.latched)  # the older of the two: neither may fall silent alone
        if latched != self._last.t:
            self.node.answered(motion)
            jump = self._angle.step(struct.unpack("<i", motion.data)[0])
            if jump:
                flags |= Flag.EPOCH
                self._blame(f"the motor's count jumped by {jump} between two readings: reset, or a count lost")
        counts = self._direction * (self._angle.counts or 0)
        tau = self._direction * permille / PERMILLE * self._rated
        self._last = DriveReading(latched, counts * self._step, counts, tau, flags)
        return self._told(self._last)

    def _judge(self, statusword: int, mode: int) -> None:
        state = state_of(statusword)
        if state.startswith("fault"):
            self._blame(self.node.emergency or f"{self.node.who} is in {state}")
        elif self._enabled and state != "operation enabled":
            self._blame(f"{self.node.who} left operation by itself: {state} (safe torque off?)")
        elif self._enabled and mode != TORQUE_MODE:
            self._blame(f"{self.node.who} left torque mode: 6061h is {mode}")
        if self._enabled and (told := self.node.trouble(self.bus.clock.now())):
            self._blame(told)

    def _told(self, reading: DriveReading) -> DriveReading:
        return reading._replace(fault=self._trouble or self.bus.dead) if self._trouble or self.bus.dead else reading

    def _blame(self, why: str) -> None:
        self._trouble = self._trouble or why  # the first cause stays

    def write(self, setpoint: Setpoint) -> float:
        """Per mille of the rated torque, within the limit; zero unless enabled."""
        if not self._enabled:
            return 0.0
        limit = self.place.torque_limit
        asked = setpoint.tau if math.isfinite(setpoint.tau) else 0.0
        tau = min(max(asked, -limit), limit)
        permille = int(tau / self._rated * PERMILLE)  # towards zero: never more than was asked
        self._saturated = int(Flag.SATURATED_DRIVE) if abs(asked) > limit else 0
        if self.bus.synced - self._last.t > UNANSWERED * self.place.period:
            return 0.0  # a drive that is not heard may not hear: nothing is queued that could reach it later
        if not self.bus.send(self._identifiers[0], encode_command(ENABLE, self._direction * permille)):
            return 0.0
        return permille / PERMILLE * self._rated

    def halt(self) -> bool:
        """Disable voltage at once; True when a statusword confirms that nothing is energised. Never raises."""
        self._enabled = False
        if not self._connected:
            return False
        self.bus.discard()
        for _ in range(2):  # one may meet a full queue
            self.bus.send(self._identifiers[0], encode_command(DISABLE, 0))
        off = self._confirmed_off()
        with contextlib.suppress(
            NotReady
        ):  # who cannot be disarmed trips by its watchdog: it is without torque already
            self._disarm()
        return off

    def _confirmed_off(self) -> bool:
        """By the statusword after a SYNC: SDO answers may be late, or somebody else's."""
        command, status, _ = self._identifiers
        until = self.bus.clock.now() + CONFIRM
        while self.bus.clock.now() < until and not self.bus.dead:
            self.bus.frames.pop(status, None)
            self.bus.sync()
            self.bus.wait(CONFIRM / 10, lambda: status in self.bus.frames)
            frame = self.bus.frames.get(status)
            if frame is not None and len(frame.data) == 5:
                if state_of(decode_status(frame.data)[0]) not in ("operation enabled", "quick stop active"):
                    return True
                self.bus.send(command, encode_command(DISABLE, 0))
        return False

    def reset_fault(self) -> None:
        """The rising edge of bit 7, then disabled. Raises NotReady when the fault stays."""
        if not self._connected:
            raise NotReady("the drive is not connected")
        command = self._identifiers[0]
        for word in (DISABLE, RESET, DISABLE):
            self.bus.send(command, encode_command(word, 0))
            self.bus.wait(0.01, lambda: False)
        state = state_of(self.node.read_uint(0x6041))
        if state.startswith("fault"):
            raise NotReady(f"{self.node.who} stays in {state} after a reset: {self._error()}")
        if self.node.rebooted:
            raise NotReady(f"{self.node.who} rebooted: disconnect and connect again, its configuration is lost")
        self.node.forget()
        self._trouble = ""
        self._first_reading()  # or the last statusword, still a fault, would be read again
