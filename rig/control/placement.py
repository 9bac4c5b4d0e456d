"""Gains of the position loop from what the motor has to move, by placing its three poles on one spot."""

from __future__ import annotations

from rig.control.pid import Gains

SHORTEST_FILTER = 0.001  # s, one tick at 1 kHz
LONGEST_FILTER = 0.008  # s
FILTER_SHARE = 5.0  # the speed filter is this much faster than the loop, so that it hardly bends the phase


def place_poles(inertia: float, bandwidth: float, torque_limit: float, friction: float, viscous: float) -> Gains:
    """Gains that give J·s³ + K_d·s² + K_p·s + K_i = J·(s + λ)³      [astrom2006]

    `inertia` J kg·m² at the motor, `bandwidth` λ rad/s, `torque_limit` N·m, `friction` N·m the integral must be able to
    hold twice over, `viscous` N·m·s/rad fed forward.
    """
    return Gains(
        Kp=3 * inertia * bandwidth**2,
        Ki=inertia * bandwidth**3,
        Kd=3 * inertia * bandwidth,
        integrator_limit=min(torque_limit, max(0.3 * torque_limit, 3 * friction)),
        torque_limit=torque_limit,
        feedforward=viscous,
    )


def speed_filter(bandwidth: float) -> float:
    """Time constant [s] of the speed filter that goes with `bandwidth` rad/s."""
    return min(LONGEST_FILTER, max(SHORTEST_FILTER, 1.0 / (FILTER_SHARE * bandwidth)))
