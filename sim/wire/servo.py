"""The drive's inner loops: what torque it makes of its target, in each mode, while its power stage is on."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import final

from sim.parameters import TwinParameters

PERIOD = 0.0005  # s, of the velocity and position loops: 2 kHz
VELOCITY_RATE = 2.0 * math.pi * 25.0  # rad/s, bandwidth of the velocity loop; the gear has a mode at 25 Hz
INTEGRAL_SHARE = 0.25  # of that bandwidth, where the integral part takes over
POSITION_RATE = 2.0 * math.pi * 5.0  # rad/s, bandwidth of the position loop: a fifth of the one inside


@dataclass(frozen=True)
class Motion:
    """What the drive knows of its motor: angle [rad] and speed [rad/s]."""

    theta: float
    omega: float


class Loop(ABC):
    """Target to torque, once every PERIOD."""

    @abstractmethod
    def aim(self, target: float) -> None:
        """A new target: rad or rad/s."""

    def following_error(self, theta: float) -> float:
        """Demand less actual angle [rad]; zero where no angle is demanded."""
        return 0.0

    @abstractmethod
    def torque(self, now: Motion, limit: float) -> float:
        """Torque asked of the motor [N·m], within ±`limit`."""


@final
class VelocityLoop(Loop):
    """τ = J·ω_b·(e + ω_b/4·∫e dt), e = target − ω_m; the integral waits while the torque is at its limit.

    `J` is what the motor feels of a stiff gear, J_m + J_l/N².
    """

    def __init__(self, parameters: TwinParameters) -> None:
        gear = parameters.gear
        self._gain = (gear.J_m + gear.J_l / gear.ratio**2) * VELOCITY_RATE  # N·m·s/rad
        self._integral = 0.0  # rad
        self.target = 0.0  # rad/s

    def aim(self, target: float) -> None:
        self.target = target

    def torque(self, now: Motion, limit: float) -> float:
        error = self.target - now.omega
        integral = self._integral + error * PERIOD
        tau = self._gain * (error + INTEGRAL_SHARE * VELOCITY_RATE * integral)
        if abs(tau) <= limit:
            self._integral = integral
            return tau
        return math.copysign(limit, tau)


@final
class PositionLoop(Loop):
    """A proportional position loop around the velocity loop; the target's own speed is fed forward.

    Targets come every `interval` s and are joined by straight lines, so the drive is one interval late.
    """

    def __init__(self, parameters: TwinParameters, theta: float, interval: float) -> None:
        self.inner = VelocityLoop(parameters)
        self._interval = interval
        self._target = theta  # rad
        self._speed = 0.0  # rad/s, on the way to the target
        self._place = theta  # rad, on the line now

    def aim(self, target: float) -> None:
        self._speed = (target - self._place) / self._interval
        self._target = target

    def following_error(self, theta: float) -> float:
        return self._place - theta

    def torque(self, now: Motion, limit: float) -> float:
        step = self._speed * PERIOD
        if abs(step) >= abs(self._target - self._place):
            step = self._target - self._place
        self._place += step
        self.inner.target = POSITION_RATE * (self._place - now.theta) + step / PERIOD
        return self.inner.torque(now, limit)


@final
class Braking(Loop):
    """A velocity loop whose target falls from the speed it starts at to rest at `deceleration` rad/s²."""

    def __init__(self, parameters: TwinParameters, omega: float, deceleration: float) -> None:
        self.inner = VelocityLoop(parameters)
        self.inner.target = omega
        self._step = deceleration * PERIOD  # rad/s

    def aim(self, target: float) -> None:
        """Targets do not matter while it brakes."""

    @property
    def finished(self) -> bool:
        """Whether the target is at rest."""
        return self.inner.target == 0.0

    def torque(self, now: Motion, limit: float) -> float:
        left = self.inner.target
        self.inner.target = math.copysign(max(0.0, abs(left) - self._step), left)
        return self.inner.torque(now, limit)
