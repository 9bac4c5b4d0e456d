"""What the rig said at one tick, and what was asked of it in return."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

NAN = float("nan")


class Sample(NamedTuple):
    """One tick's measurement in SI. Not measured is NaN (null in the file), never 0."""

    t: float  # s, since the run's start, when the motor angle was latched
    theta_m: float  # rad
    theta_l: float  # rad
    omega_m: float  # rad/s, host-filtered
    tau_m: float  # N·m, motor side
    tau_l: float  # N·m, torque sensor
    age: float  # s, of the oldest channel
    counts_m: int
    counts_l: int
    flags: int  # channels.Flag
    fault: str  # the drive's own fault in words, "" when it has none


class Torque(NamedTuple):
    """Ask the drive for a motor torque. `theta_ref` and its speed are the reference it serves, where there is one."""

    tau: float  # N·m, motor side
    theta_ref: float = NAN  # rad
    omega_ref: float = 0.0  # rad/s


class Velocity(NamedTuple):
    """Ask the drive, which closes the velocity loop itself, for a motor speed."""

    omega: float  # rad/s
    theta_ref: float = NAN  # rad
    omega_ref: float = 0.0  # rad/s


class Position(NamedTuple):
    """Ask the drive, which closes the position loop itself, for a motor angle."""

    theta: float  # rad
    theta_ref: float = NAN  # rad
    omega_ref: float = 0.0  # rad/s


Setpoint = Torque | Velocity | Position  # the first field is what is asked for; the loop hands it on unread


class Mode(StrEnum):
    """Which loop the drive closes: what kind of setpoint it takes while it is enabled."""

    TORQUE = "torque"
    VELOCITY = "velocity"
    POSITION = "position"
