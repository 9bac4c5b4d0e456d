"""Gains of the position loop from what the motor has to move: the speed loop first, the rest well below it."""

from __future__ import annotations

from rig.core.gains import Gains

POSITION = 8.0  # the position pole lies this far below the speed pole, so that it costs the speed loop no phase
INTEGRAL = 24.0  # and the integral's pole this far
SHORTEST_FILTER = 0.001  # s, one tick at 1 kHz
LONGEST_FILTER = 0.008  # s
FILTER_SHARE = 5.0  # the speed filter is this much faster than the loop, so that it hardly bends the phase


def place_poles(inertia: float, bandwidth: float, torque_limit: float, friction: float, viscous: float) -> Gains:
    """Gains that give J·s³ + K_d·s² + K_p·s + K_i = J·(s + β)(s + β/8)(s + β/24)      [astrom2006]

    `inertia` J kg·m² at the motor, `bandwidth` β rad/s, `torque_limit` N·m, `friction` N·m the integral must be able to
    hold three times over, `viscous` N·m·s/rad fed forward. Poles far apart: friction that falls with speed is an
    unstable pole, and it takes a fast, well damped speed loop to hold it, not a stiff position loop.
    """
    fast, middle, slow = bandwidth, bandwidth / POSITION, bandwidth / INTEGRAL
    return Gains(
        Kp=inertia * (fast * middle + fast * slow + middle * slow),
        Ki=inertia * fast * middle * slow,
        Kd=inertia * (fast + middle + slow),
        integrator_limit=min(torque_limit, max(0.3 * torque_limit, 3 * friction)),
        torque_limit=torque_limit,
        feedforward=viscous,
    )


def speed_filter(bandwidth: float) -> float:
    """Time constant [s] of the speed filter that goes with `bandwidth` rad/s."""
    return min(LONGEST_FILTER, max(SHORTEST_FILTER, 1.0 / (FILTER_SHARE * bandwidth)))
