"""The spring by pieces: on each its torque is a straight line in φ, and where the piece ends is an event.

Pieces end at the breaks of the law (dead zone, K1/K2/K3) and where an element of the hysteresis begins or ceases to
slip. The elements are Maxwell's, in parallel: one carries k_i·x_i, its x_i follows φ and slips at ±s_i. So loops do not
depend on rate, minor loops close, and what a slipping element turns to heat, k_i·s_i·|Δφ|, is exact.
"""

from __future__ import annotations

import math

from numba import njit

from sim.kernel import layout as at
from sim.kernel.layout import Slow, Spring, Vector


@njit
def piece(phi: float, phi_rate: float, slow: Slow | None, state: Vector, p: Vector) -> Spring:
    """The piece on which φ now is, going at `phi_rate` rad/s."""
    if slow is None:
        return Spring(0.0, p[at.K], 1.0, 0.0, -math.inf, math.inf, 0.0, 0.0)
    spring = law(phi, p)
    if p[at.SLIPS] == 0.0:
        return spring
    offset, slope, low, high = spring.offset, spring.slope, spring.low, spring.high
    slip, slipping = 0.0, 0.0
    place = int(p[at.SLIPS_AT])
    for i in range(int(p[at.SLIPS])):
        k, s, x = p[place], p[place + 1], state[at.STATE_SIZE + i]
        offset += k * x
        if abs(x) >= s and x * phi_rate > 0.0:
            slip, slipping = math.copysign(1.0, x), slipping + k * x
        else:
            offset, slope = offset - k * phi, slope + k
            low, high = max(low, phi - s - x), min(high, phi + s - x)
        place += 2
    return Spring(offset, slope, spring.live, spring.shift, low, high, slip, slipping)


@njit
def law(phi: float, p: Vector) -> Spring:
    """Dead zone, K1, K2, K3: odd and continuous."""
    size, side = abs(phi), math.copysign(1.0, phi)
    shift = side * p[at.GAP]
    if size <= p[at.GAP] and p[at.GAP] > 0.0:
        return Spring(0.0, 0.0, 0.0, 0.0, -p[at.GAP], p[at.GAP], 0.0, 0.0)
    if size <= p[at.BREAK_1]:
        begin, end, torque, k = p[at.GAP], p[at.BREAK_1], 0.0, p[at.K]
        if begin == 0.0:  # one piece through zero
            begin = -end
    elif size <= p[at.BREAK_2]:
        begin, end, torque, k = p[at.BREAK_1], p[at.BREAK_2], p[at.TORQUE_1], p[at.K_2]
    else:
        begin, end, torque, k = p[at.BREAK_2], math.inf, p[at.TORQUE_2], p[at.K_3]
    offset = side * (torque - k * max(begin, 0.0))
    return Spring(offset, k, 1.0, shift, min(side * begin, side * end), max(side * begin, side * end), 0.0, 0.0)


@njit
def left(phi: float, phi_rate: float, slow: Slow | None, spring: Spring) -> bool:
    """Whether φ is no longer on the piece; the paper's spring has but one."""
    if slow is None:
        return False
    return phi > spring.high or phi < spring.low or spring.slip * phi_rate < 0.0


@njit
def follow(step: float, slow: Slow | None, spring: Spring, state: Vector, p: Vector) -> None:
    """Let the elements follow φ by `step` rad on one piece; those that slip turn their share to heat."""
    if slow is None:
        return
    place = int(p[at.SLIPS_AT])
    for i in range(int(p[at.SLIPS])):
        s, x = p[place + 1], state[at.STATE_SIZE + i]
        if not (spring.slip != 0.0 and x * spring.slip >= s):
            state[at.STATE_SIZE + i] = max(-s, min(s, x + step))
        place += 2
    state[at.LOST_HYSTERESIS] += spring.slipping * step


@njit
def stiffest(phi: float, spring: Spring, p: Vector) -> float:
    """The steepest the spring may be here [N·m/rad]."""
    bent = spring.live * (phi - spring.shift)
    return spring.slope + 3.0 * p[at.CUBIC] * bent * bent + abs(p[at.KAPPA]) + p[at.CREEP_K_1] + p[at.CREEP_K_2]
