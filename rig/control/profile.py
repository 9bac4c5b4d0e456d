"""References: offset and speed as pure functions of time since the start."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True)
class Triangle:
    """0 → +A → −A → 0, `cycles` times: the slow measurement's reference, ±1440° at 0.01 Hz      [ghorbel2001]"""

    amplitude: float  # rad, zero to peak
    frequency: float  # Hz
    cycles: float

    @cached_property  # asked for every tick
    def duration(self) -> float:
        """s"""
        return self.cycles / self.frequency

    @cached_property
    def speed(self) -> float:
        """Slope 4·A·f, rad/s."""
        return 4.0 * self.amplitude * self.frequency

    def at(self, t: float) -> tuple[float, float]:
        """Offset [rad] and speed [rad/s] at `t` s; at rest on zero before and after."""
        if not 0.0 <= t < self.duration:
            return 0.0, 0.0
        phase = t * self.frequency % 1.0
        if phase < 0.25:
            return 4.0 * self.amplitude * phase, self.speed
        if phase < 0.75:
            return self.amplitude * (2.0 - 4.0 * phase), -self.speed
        return self.amplitude * (4.0 * phase - 4.0), self.speed


@dataclass(frozen=True)
class Trapezoid:
    """0 → `distance`, with limited speed and acceleration; at rest at both ends."""

    distance: float  # rad, signed
    speed: float  # rad/s, > 0
    acceleration: float  # rad/s², > 0

    @cached_property
    def peak(self) -> float:
        """Speed really reached [rad/s]: short moves never get to `speed`."""
        return min(self.speed, math.sqrt(abs(self.distance) * self.acceleration))

    @cached_property
    def duration(self) -> float:
        """s"""
        if self.peak == 0.0:  # nowhere to go, or so little that the square root of it vanishes
            return 0.0
        return abs(self.distance) / self.peak + self.peak / self.acceleration

    def at(self, t: float) -> tuple[float, float]:
        """Offset [rad] and speed [rad/s] at `t` s; at rest before and after."""
        if t <= 0.0:
            return 0.0, 0.0
        if t >= self.duration:
            return self.distance, 0.0
        sign = math.copysign(1.0, self.distance)
        ramp = self.peak / self.acceleration
        left = self.duration - t
        if t < ramp:
            return sign * self.acceleration * t * t / 2, sign * self.acceleration * t
        if left < ramp:
            return self.distance - sign * self.acceleration * left * left / 2, sign * self.acceleration * left
        return sign * self.peak * (t - ramp / 2), sign * self.peak


@dataclass(frozen=True)
class Ramp:
    """From one speed to another at constant acceleration, and on at that speed for as long as one likes."""

    start: float  # rad/s
    end: float  # rad/s
    acceleration: float  # rad/s², > 0

    @cached_property
    def duration(self) -> float:
        """s until the end speed is reached."""
        return abs(self.end - self.start) / self.acceleration

    @cached_property
    def travel(self) -> float:
        """rad, signed, until then."""
        return 0.5 * (self.start + self.end) * self.duration

    def at(self, t: float) -> tuple[float, float]:
        """Offset [rad] and speed [rad/s] at `t` s; at its start before."""
        if t <= 0.0:
            return 0.0, self.start
        if t >= self.duration:
            return self.travel + self.end * (t - self.duration), self.end
        slope = math.copysign(self.acceleration, self.end - self.start)
        return (self.start + 0.5 * slope * t) * t, self.start + slope * t
