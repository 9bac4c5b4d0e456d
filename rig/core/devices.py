"""What a device promises, real or simulated: bytes or physics inside, SI outside, reading never waits.

Life of a device: `connect` (moves and energises nothing) → `read` … → `close`. A drive is energised by `enable` and
made torque-free by `halt`, which works in any state, any number of times, and never raises.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar, NamedTuple

from rig.core.errors import NotReady
from rig.core.sample import Mode, Setpoint


class Identity(NamedTuple):
    """Who answered: as read from the device, not from the configuration."""

    model: str
    serial: str = ""
    firmware: str = ""

    @property
    def simulated(self) -> bool:
        """True when the device itself says that it is the twin's, over whatever wire."""
        return "twin" in self.model.lower().split()


class AngleReading(NamedTuple):
    """The newest angle. `t` is when it was latched, on the clock of the loop [s]."""

    t: float
    theta: float  # rad, unwrapped, sign as configured
    counts: int  # raw, unwrapped
    flags: int = 0


class TorqueReading(NamedTuple):
    """The newest torque-sensor value. `t` is when it was latched, on the clock of the loop [s]."""

    t: float
    tau: float  # N·m
    flags: int = 0


class DriveReading(NamedTuple):
    """The newest state of the drive: its encoder, the torque it reports, its fault in words ("" = none)."""

    t: float
    theta_m: float  # rad
    counts: int
    tau_m: float  # N·m
    flags: int = 0
    fault: str = ""


class Watchdog(NamedTuple):
    """What stops a drive by itself once this program falls silent, in `words`, "" for nothing; whether it was seen at
    work or read back."""

    words: str = ""
    is_proven: bool = False


UNGUARDED = (
    "nothing stops the drive when this program dies: it has no watchdog that this program could set or was told of"
)


class Device(ABC):
    """Anything the bench can open."""

    name: str
    keys: ClassVar[tuple[str, ...]] = ()  # of its section in the bench file that mean something to it, beside `type`
    remarks: Sequence[str] = ()  # what a person should know of it once it is connected, one sentence each
    trouble: str = ""  # what is wrong with the device itself, in words, as of the last reading; a drive says it there

    @property
    def silent(self) -> str:
        """Which of its messages stays away while its others come, in words; "" when none does, or it has but one."""
        return ""

    @abstractmethod
    def connect(self) -> Identity:
        """Open and identify. Moves and energises nothing. Raises NotReady with the reason."""

    def clear(self) -> None:
        """Forget what was wrong, and look anew: what is still wrong is told again. Raises NotReady when that cannot be.
        A drive's fault is another matter: `reset_fault`.
        """
        self.trouble = ""

    @abstractmethod
    def close(self) -> None:
        """Let go of the device. Idempotent; never raises."""


class Encoder(Device):
    """An angle sensor of its own (the load side; the motor's encoder is read through the drive)."""

    @abstractmethod
    def read(self) -> AngleReading:
        """The newest angle; never waits for one."""


class TorqueSensor(Device):
    """The torque sensor between gear and load."""

    @abstractmethod
    def read(self) -> TorqueReading:
        """The newest torque; never waits for one."""


class Drive(Device):
    """The servo drive with its motor encoder."""

    watchdog: Watchdog | None = None  # None of a drive that lives in this program and dies with it
    voltage: bool | None = None  # at its power stage, as it told with the last reading; None: it does not tell

    @abstractmethod
    def enable(self, mode: Mode = Mode.TORQUE) -> None:
        """Energise for setpoints of `mode`: with zero torque, at rest, or held where it is. Idempotent.

        Raises NotReady when the drive refuses, or does not know the mode.
        """

    @abstractmethod
    def read(self) -> DriveReading:
        """The newest state; never waits for one."""

    @abstractmethod
    def write(self, setpoint: Setpoint) -> float:
        """Command it; returns what the frame could carry, in the setpoint's unit; where none could be sent, what the
        one before carried, by which the drive still goes. Without effect unless enabled: then a torque or speed is 0,
        an angle NaN.
        """

    def cut(self) -> None:
        """Torque off is commanded, as by `halt`, where that can be without waiting for the drive to confirm it."""
        self.halt()

    @abstractmethod
    def halt(self) -> bool:
        """Torque off now (stop category 0). Any state, any number of times, never raises; True when confirmed."""

    @abstractmethod
    def reset_fault(self) -> None:
        """Clear a fault of the drive. Never energises it."""


def torque_only(who: str, mode: Mode) -> None:
    """Raises NotReady for a mode other than torque, in a drive that has no other."""
    if mode is not Mode.TORQUE:
        raise NotReady(f'{who} takes torques only, not {mode} setpoints: control.mode = "torque" in the bench file')
