"""One slow turn of the motor under its position loop, read in parts of the middle half, where its speed is constant."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Generator, Sequence
from typing import Final

from rig.control.pid import Pid
from rig.control.profile import Trapezoid
from rig.core.procedure import Setting
from rig.core.sample import Sample, Setpoint, Torque
from rig.core.units import RPM, TURN

BLOCKS: Final = 8  # equal parts whose means tell how sure the mean of all is
RISE: Final = 0.3  # s in which the reference comes to its speed
DWELL: Final = 0.5  # s after the turn, for what swings to come to rest


def one_turn(speed_rpm: float) -> Trapezoid:
    """A whole one, over which the kinematic error averages out."""
    speed = speed_rpm * RPM
    return Trapezoid(TURN, speed, speed / RISE)


def leg(
    setting: Setting, move: Trapezoid, direction: int, take: Callable[[int, Sample], None]
) -> Generator[Setpoint, Sample, tuple[Sample, Sample]]:
    """Turn `move` in a `direction` of ±1; `take` gets every sample of the middle half with the part it is in. Returns
    the first and the last sample."""
    pid = Pid(setting.control, setting.period)
    sample = first = yield Torque(0.0)
    while (t := sample.t - first.t) < move.duration + DWELL:
        offset, omega = move.at(t)
        block = int((t / move.duration - 0.25) * 2 * BLOCKS)
        if 0 <= block < BLOCKS:
            take(block, sample)
        theta_ref, omega_ref = first.theta_m + direction * offset, direction * omega
        tau = pid.step(theta_ref, omega_ref, sample.theta_m, sample.omega_m)
        sample = yield Torque(tau, theta_ref, omega_ref)
    return first, sample


def standard_error(*means: Sequence[float]) -> float:
    """Of the sum or difference of means over BLOCKS parts each, in their unit. From the scatter of whole parts:
    friction and stick-slip make neighbouring samples anything but independent."""
    return math.sqrt(sum(statistics.pvariance(parts) for parts in means) / (BLOCKS - 1))
