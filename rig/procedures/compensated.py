"""The load along its reference, the motor along one that takes the gear's kinematic error into account beforehand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from rig.control.filter import SpeedFilter
from rig.control.pid import Pid
from rig.control.profile import Trapezoid
from rig.core.errors import UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.core.units import RPM, TURN

ACCELERATION = 40.0  # rad/s² of the motor: 500 rpm in 1.3 s
SETTLE = 1.0  # s at speed: ten time constants of the paper's rig under its loop
PAUSE = 0.5  # s at rest before, between and after
CLOSE = 1e-9  # rad of the motor, a millionth of a count
STEEPEST = 0.5  # N·|θ̃′|: a gear's own is 0.02; above this the reference might run backwards


class Inverse:
    """The motor angle at which the output is where a gear without error would have it.

    θ_m = x + N·θ̃(θ_m),  θ̃ = Re Σ c_n·exp(jnθ_m),  c_n = a_n − j·b_n, `x` the motor angle of an ideal gear; solved by
    Newton's method from the last one      [ghorbel2001, Eqs. 1, 8]
    """

    def __init__(self, a: Sequence[float], b: Sequence[float], ratio: float) -> None:
        self._c = [ratio * complex(p, -q) for p, q in zip(a, b, strict=True)]

    def error(self, theta: float) -> tuple[float, float]:
        """N·θ̃ [rad] and its slope at a motor angle."""
        z = complex(math.cos(theta), math.sin(theta))
        value, slope = 0j, 0j
        for n in range(len(self._c), 0, -1):
            value, slope = (value + self._c[n - 1]) * z, (slope + 1j * n * self._c[n - 1]) * z
        return value.real, slope.real

    def solve(self, x: float, guess: float) -> tuple[float, float]:
        """θ_m for `x` [rad], and dθ_m/dx there."""
        theta = guess
        for _ in range(8):
            value, slope = self.error(theta)
            step = (theta - value - x) / (1.0 - slope)
            theta -= step
            if abs(step) < CLOSE:
                break
        return theta, 1.0 / (1.0 - self.error(theta)[1])


@dataclass(frozen=True)
class Compensated(Procedure):
    """Forth and back at one speed of the output; the motor's reference carries the kinematic error it is told of.

    Without coefficients it is the same motion uncompensated. The motor is also given the torque that the compensating
    part of its acceleration takes, `inertia` times it, or at speed the loop would lag behind it; and its reference's
    speed goes through the filter its own speed goes through, or their difference would act like an inertia more. In the
    run `theta_ref` is the motor's reference; what the load was to do is theta_ref − N·θ̃(theta_ref).
    """

    name: ClassVar[str] = "other"
    label: ClassVar[str] = "compensated"
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l")

    speed_rpm: float = 9.6  # of the motor, mean
    revolutions: int = 8  # of the motor each way, at speed
    a: tuple[float, ...] = field(default=(), metadata={"signed": True})  # rad at the output, orders 1, 2, …
    b: tuple[float, ...] = field(default=(), metadata={"signed": True})  # rad at the output, of the sines
    inertia: float = field(default=0.0, metadata={"signed": True})  # kg·m², motor side
    speed_filter: float = field(default=0.0, metadata={"signed": True})  # s, of the host's estimate of speed

    def __post_init__(self) -> None:
        if len(self.a) != len(self.b):
            raise UsageError(f"{len(self.a)} cosine and {len(self.b)} sine coefficients: expected as many of each")
        if self.inertia < 0.0 or self.speed_filter < 0.0:
            raise UsageError(
                f"inertia = {self.inertia:g} kg·m², speed_filter = {self.speed_filter:g} s: expected 0 or more of both"
            )

    @property
    def steepness(self) -> float:
        """The most |θ̃′| can be [rad/rad]."""
        return sum(n * math.hypot(p, q) for n, (p, q) in enumerate(zip(self.a, self.b, strict=True), 1))

    @property
    def lead(self) -> int:
        """Turns before and after what is measured: to get up to speed, and for the loop to come to rest there."""
        omega = self.speed_rpm * RPM
        return math.ceil((omega * SETTLE + omega**2 / (2 * ACCELERATION)) / TURN)

    def way(self) -> Trapezoid:
        """One way, of an ideal gear's motor."""
        return Trapezoid((self.revolutions + 2 * self.lead) * TURN, self.speed_rpm * RPM, ACCELERATION)

    def envelope(self, setting: Setting) -> Envelope:
        """The compensating part adds a few per cent of speed and a fraction of a degree of way."""
        way, more = self.way(), 1.0 + setting.ratio * self.steepness
        return Envelope(
            2 * way.duration + 3 * PAUSE, way.distance + 1.0, way.speed * more * 1.05, setting.control.torque_limit
        )

    def conditions(self) -> dict[str, Any]:
        """For the manifest, with what is fed forward."""
        return {
            "output_locked": False, "tau_ext": 0.0, "speed_rpm": self.speed_rpm, "revolutions": self.revolutions,
            "lead_turns": self.lead,
            "feedforward_a": list(self.a), "feedforward_b": list(self.b),
        }  # fmt: skip

    def steps(self, setting: Setting) -> Steps:
        """Hold, forth, hold, back, hold. Raises UsageError for an error so steep that its inverse is none."""
        steep = setting.ratio * self.steepness
        if steep > STEEPEST:
            raise UsageError(f"N·θ̃′ reaches {steep:.2f}: no gear's kinematic error is so steep; expected below 0.5")
        inverse, slow = Inverse(self.a, self.b, setting.ratio), SpeedFilter(self.speed_filter)
        pid, way = Pid(setting.control, setting.period), self.way()
        sample = yield Torque(0.0)
        start, theta_ref, last = sample.t, sample.theta_m, 0.0
        home = theta_ref - inverse.error(theta_ref)[0]
        end = 3 * PAUSE + 2 * way.duration
        while sample.t < start + end:
            offset, omega, alpha = self._at(way, sample.t - start)
            theta_ref, gain = inverse.solve(home + offset, theta_ref)
            omega_ref = omega * gain
            extra = (omega_ref - last) / setting.period - alpha  # the compensating part of the acceleration alone
            last = omega_ref
            seen = slow.step(sample.t, theta_ref)
            tau = pid.step(theta_ref, seen, sample.theta_m, sample.omega_m) + self.inertia * extra
            limit = setting.control.torque_limit
            sample = yield Torque(min(max(tau, -limit), limit), theta_ref, omega_ref)

    def _at(self, way: Trapezoid, t: float) -> tuple[float, float, float]:
        """Offset [rad], speed [rad/s], acceleration [rad/s²] of an ideal gear's motor at `t` s."""
        forth, back = t - PAUSE, t - 2 * PAUSE - way.duration
        if back >= 0.0:
            offset, omega = way.at(back)
            return way.distance - offset, -omega, -_acceleration(way, back)
        offset, omega = way.at(forth)
        return offset, omega, _acceleration(way, forth)


def _acceleration(way: Trapezoid, t: float) -> float:
    """rad/s²"""
    ramp = way.peak / way.acceleration
    if 0.0 < t < ramp:
        return way.acceleration
    return -way.acceleration if way.duration - ramp < t < way.duration else 0.0
