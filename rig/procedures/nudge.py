"""A ramp of open-loop torque until the motor moves a little: what is held is found before a blow could wind it up."""

from __future__ import annotations

import math
from collections.abc import Generator

from rig.core.errors import NotReady
from rig.core.procedure import Setting
from rig.core.sample import Sample, Setpoint, Torque
from rig.core.units import DEG

DEAD = 5.0  # times the motion looked for, by the load encoder: then the motor encoder should have shown it
HELD = 0.1  # of what the load should have moved: less is a load that does not follow at all
REST = 0.3  # s without torque: friction brings it to rest


def nudge(setting: Setting, limit: float, rate: float, angle: float) -> Generator[Setpoint, Sample, float]:
    """Ramp the torque at `rate` N·m/s to at most `limit` N·m until the motor has moved by `angle` deg; then let it come
    to rest. Returns the torque that set it moving. Raises NotReady: it moves the wrong way, or not, or the load does
    not follow.
    """
    sample = yield Torque(0.0)
    home, load, tau = sample.theta_m, sample.theta_l, 0.0
    dead = DEAD * angle * DEG / setting.ratio
    while abs(moved := sample.theta_m - home) < angle * DEG:
        tau += rate * setting.period
        if tau > limit:
            raise NotReady(
                f"the motor did not turn {angle:g}° with up to {limit:.2f} N·m, of which the drive says it gave "
                f"{sample.tau_m:.2f} N·m ({moved / DEG:+.2f}°): is it blocked, has the drive a limit or a torque scale "
                "of its own, is its encoder read?"
            )
        sample = yield Torque(tau)
        if abs(sample.theta_l - load) > dead:
            raise NotReady(
                f"the load turned by {(sample.theta_l - load) / DEG:+.2f}° while the motor encoder shows "
                f"{(sample.theta_m - home) / DEG:+.2f}°: is the motor encoder read at all?"
            )
    if moved < 0:
        raise NotReady(
            f"{tau:.2f} N·m of positive torque turned the motor by {moved / DEG:+.1f}°, expected a positive angle: "
            "motor encoder or torque command has the wrong sign"
        )
    begin = sample.t
    while sample.t - begin < REST:
        sample = yield Torque(0.0)
    if not math.isnan(load):
        refuse_held(angle * DEG, sample.theta_l - load, setting.ratio)
    return tau


def refuse_held(motor: float, load: float, ratio: float) -> None:
    """Raises NotReady when the load [rad] hardly moved while the motor did [rad]."""
    if not abs(load) > HELD * abs(motor) / ratio:
        raise NotReady(
            f"the load encoder moved {load / DEG:.3f}° while the motor turned {motor / DEG:.1f}°, "
            f"expected {motor / ratio / DEG:.2f}°: is the output locked or the encoder unplugged?"
        )
