"""The position loop of the slow measurement, closed on the host as in the paper."""

from __future__ import annotations

from rig.core.gains import Gains


class Pid:
    """τ = clip(K_p·e + I + K_d·(ω_ref − ω) + B_ff·ω_ref),  İ = K_i·e,  e = θ_ref − θ      [astrom2006]

    The derivative acts on the filtered measurement ω, never on e: a step of the reference gives no kick beyond
    the feed-forward (K_d + B_ff)·ω_ref. The integral is clamped, and held while the torque limit is reached and
    the error would push further into it.
    """

    __slots__ = ("gains", "integral", "period")

    def __init__(self, gains: Gains, period: float) -> None:
        self.gains = gains
        self.period = period  # s
        self.integral = 0.0  # N·m

    def take_over(self, tau: float, omega_ref: float) -> None:
        """Go on from the torque `tau` [N·m] there is, at a reference of `omega_ref` rad/s: what the feed-forward gives
        of it is not given twice.
        """
        g = self.gains
        self.integral = max(-g.integrator_limit, min(g.integrator_limit, tau - g.feedforward * omega_ref))

    def step(self, theta_ref: float, omega_ref: float, theta: float, omega: float) -> float:
        """Torque [N·m] for this tick from reference and measurement (rad, rad/s)."""
        g = self.gains
        error = theta_ref - theta
        rest = g.Kp * error + g.Kd * (omega_ref - omega) + g.feedforward * omega_ref
        integral = self.integral + g.Ki * error * self.period
        if integral > g.integrator_limit:
            integral = g.integrator_limit
        elif integral < -g.integrator_limit:
            integral = -g.integrator_limit
        tau = rest + integral
        if tau > g.torque_limit:
            self.integral = min(integral, self.integral)
            return g.torque_limit
        if tau < -g.torque_limit:
            self.integral = max(integral, self.integral)
            return -g.torque_limit
        self.integral = integral
        return tau
