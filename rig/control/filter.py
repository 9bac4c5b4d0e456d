"""Speed from an encoder: the first-order filtered derivative the guard and the controller share."""

from __future__ import annotations


class SpeedFilter:
    """ω ← ω + (Δθ/Δt − ω)·Δt/(T + Δt) with the measured Δt: late or skipped ticks give no spike."""

    __slots__ = ("omega", "t", "theta", "time_constant")

    def __init__(self, time_constant: float) -> None:
        self.time_constant = time_constant  # s
        self.omega = 0.0  # rad/s
        self.t = float("nan")
        self.theta = 0.0

    def step(self, t: float, theta: float) -> float:
        """Filtered speed [rad/s] after angle `theta` rad at `t` s. The first call, or no new time, keeps it."""
        dt = t - self.t
        if dt > 0.0:
            self.omega += ((theta - self.theta) / dt - self.omega) * dt / (self.time_constant + dt)
        elif dt == dt:  # not the first call: time stood still, the angle is no news
            return self.omega
        self.t, self.theta = t, theta
        return self.omega
