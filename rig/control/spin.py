"""Pieces of procedures that turn the motor one way: up to a speed and held there by the loop, and gently down again."""

from __future__ import annotations

import math
from collections.abc import Generator

from rig.control.brake import PATIENCE, REST_TIME, brake
from rig.control.pid import Pid
from rig.control.profile import Ramp
from rig.core.procedure import Setting, Steps
from rig.core.sample import Sample, Torque
from rig.core.units import TURN

ACCELERATION = 20.0  # rad/s²  1.2e-3 kg·m² takes 24 mN·m for it: a tenth of the friction; 500 rpm in 2.6 s
EASE = 1.0  # s the loop is given after the ramp before its torque is believed


def hold_time(omega: float, seconds: float) -> float:
    """s of holding: whole turns, so that what repeats with the angle averages out, and at least `seconds`."""
    turn = TURN / abs(omega)
    return math.ceil(seconds / turn) * turn


def hold_speed(setting: Setting, omega: float, seconds: float, beyond: float = 0.0) -> Generator[Torque, Sample, float]:
    """Up to `omega` rad/s under the position loop and on for whole turns of at least `seconds`, and `beyond` rad.

    Returns the mean torque [N·m] that held the speed over those turns: nothing accelerates on average.
    """
    pid, ramp = Pid(setting.control, setting.period), Ramp(0.0, omega, ACCELERATION)
    sample = yield Torque(0.0)
    home, begin = sample.theta_m, sample.t
    first, last = ramp.duration + EASE, ramp.duration + EASE + hold_time(omega, seconds) + beyond / abs(omega)
    total, ticks = 0.0, 0
    while (t := sample.t - begin) < last:
        offset, omega_ref = ramp.at(t)
        tau = pid.step(home + offset, omega_ref, sample.theta_m, sample.omega_m)
        if t >= first:
            total, ticks = total + tau, ticks + 1
        sample = yield Torque(tau, home + offset, omega_ref)
    return total / max(ticks, 1)


def hold_duration(omega: float, seconds: float) -> float:
    """s that `hold_speed` takes."""
    return Ramp(0.0, omega, ACCELERATION).duration + EASE + hold_time(omega, seconds)


def hold_travel(omega: float, seconds: float) -> float:
    """rad, signed, that `hold_speed` turns."""
    return Ramp(0.0, omega, ACCELERATION).travel + omega * (EASE + hold_time(omega, seconds))


def slow_down(setting: Setting, sample: Sample, tau: float) -> Steps:
    """From the speed of `sample` to rest along a ramp under the loop, which takes over from the torque `tau` N·m."""
    pid, ramp = Pid(setting.control, setting.period), Ramp(sample.omega_m, 0.0, ACCELERATION)
    pid.take_over(tau, sample.omega_m)
    home, begin = sample.theta_m, sample.t
    while (t := sample.t - begin) < ramp.duration:
        offset, omega_ref = ramp.at(t)
        asked = pid.step(home + offset, omega_ref, sample.theta_m, sample.omega_m)
        sample = yield Torque(asked, home + offset, omega_ref)
    yield from brake(setting)


def slow_down_duration(omega: float) -> float:
    """s that `slow_down` takes at most."""
    return abs(omega) / ACCELERATION + PATIENCE + REST_TIME


def slow_down_travel(omega: float) -> float:
    """rad, signed, that `slow_down` turns."""
    return Ramp(omega, 0.0, ACCELERATION).travel
