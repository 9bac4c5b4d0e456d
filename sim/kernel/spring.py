"""The spring by pieces: on each its torque is a straight line in φ, and where the piece ends is an event.

Pieces end at the breaks of the law (dead zone, K1/K2/K3) and where an element of the hysteresis begins or ceases to
slip. The elements are Maxwell's, in parallel: one carries k_i·x_i, its x_i follows φ and slips at ±s_i. So loops do not
depend on rate, minor loops close, and what a slipping element turns to heat, k_i·s_i·|Δφ|, is exact. Bristles, friction
that gives way before it slides, are the same between motor and housing.
"""

from __future__ import annotations

import math

from numba import njit

from sim.kernel import layout as at
from sim.kernel.layout import Elements, Four, Mesh, Slow, Spring, Vector

NOTHING = Elements(0.0, 0.0, -math.inf, math.inf, 0.0, 0.0)


@njit
def piece(y: Four, phi: float, phi_rate: float, slow: Slow | None, state: Vector, p: Vector) -> Spring:
    """The piece on which φ and θ_m now are, φ going at `phi_rate` rad/s."""
    if slow is None:
        return Spring(Elements(0.0, p[at.K], -math.inf, math.inf, 0.0, 0.0), 1.0, 0.0, NOTHING)
    spring, first = law(phi, p), at.STATE_SIZE
    twist = wound(spring.twist, phi, phi_rate, first, int(p[at.SLIPS]), int(p[at.SLIPS_AT]), state, p)
    first += int(p[at.SLIPS])
    bristles = wound(NOTHING, y[0], y[1], first, int(p[at.BRISTLES]), int(p[at.BRISTLES_AT]), state, p)
    return Spring(twist, spring.live, spring.shift, bristles)


@njit
def wound(
    bare: Elements, x: float, rate: float, first: int, count: int, place: int, state: Vector, p: Vector
) -> Elements:
    """`bare` and `count` elements that follow `x`, which goes at `rate`; their states begin at `first`."""
    offset, slope, low, high, slip, slipping = bare
    for i in range(first, first + count):
        k, s, held = p[place], p[place + 1], state[i]
        offset += k * held
        if abs(held) >= s and held * rate > 0.0:
            slip, slipping = math.copysign(1.0, held), slipping + k * held
        else:
            offset, slope = offset - k * x, slope + k
            # s + held first: nothing is left of it at the end of an element, so that one at rest there is not outside
            low, high = max(low, x - (s + held)), min(high, x + (s - held))
        place += 2
    return Elements(offset, slope, low, high, slip, slipping)


@njit
def law(phi: float, p: Vector) -> Spring:
    """Dead zone, K1, K2, K3: odd and continuous."""
    size, side = abs(phi), math.copysign(1.0, phi)
    if size <= p[at.GAP] and p[at.GAP] > 0.0:
        return Spring(Elements(0.0, 0.0, -p[at.GAP], p[at.GAP], 0.0, 0.0), 0.0, 0.0, NOTHING)
    if size <= p[at.BREAK_1]:
        begin, end, torque, k = p[at.GAP], p[at.BREAK_1], 0.0, p[at.K]
        if begin == 0.0:  # one piece through zero
            begin = -end
    elif size <= p[at.BREAK_2]:
        begin, end, torque, k = p[at.BREAK_1], p[at.BREAK_2], p[at.TORQUE_1], p[at.K_2]
    else:
        begin, end, torque, k = p[at.BREAK_2], math.inf, p[at.TORQUE_2], p[at.K_3]
    offset = side * (torque - k * max(begin, 0.0))
    ends = min(side * begin, side * end), max(side * begin, side * end)
    return Spring(Elements(offset, k, ends[0], ends[1], 0.0, 0.0), 1.0, side * p[at.GAP], NOTHING)


@njit
def outside_of(x: float, rate: float, elements: Elements) -> bool:
    """Whether x is no longer where the straight line holds."""
    return x > elements.high or x < elements.low or elements.slip * rate < 0.0


@njit
def left(y: Four, m: Mesh, slow: Slow | None, spring: Spring) -> bool:
    """Whether φ or θ_m is no longer on the piece; the paper's spring has but one."""
    if slow is None:
        return False
    return outside_of(m.phi, m.phi_rate, spring.twist) or outside_of(y[0], y[1], spring.bristles)


@njit
def follow(twist: float, turn: float, slow: Slow | None, spring: Spring, state: Vector, p: Vector) -> None:
    """Let the elements follow φ by `twist` and θ_m by `turn` rad on one piece; what slips goes to heat."""
    if slow is None:
        return
    first, slips = at.STATE_SIZE, int(p[at.SLIPS])
    pulled(spring.twist.slip, twist, first, slips, int(p[at.SLIPS_AT]), state, p)
    pulled(spring.bristles.slip, turn, first + slips, int(p[at.BRISTLES]), int(p[at.BRISTLES_AT]), state, p)
    state[at.LOST_HYSTERESIS] += spring.twist.slipping * twist
    state[at.LOST_MOTOR] += spring.bristles.slipping * turn


@njit
def pulled(slip: float, step: float, first: int, count: int, place: int, state: Vector, p: Vector) -> None:
    """`count` elements `step` rad further, those that slip where they are."""
    for i in range(first, first + count):
        s, held = p[place + 1], state[i]
        if slip == 0.0 or held * slip < s:
            state[i] = max(-s, min(s, held + step))
        place += 2


@njit
def stiffest(phi: float, spring: Spring, p: Vector) -> float:
    """The steepest the spring may be here [N·m/rad]."""
    bent = spring.live * (phi - spring.shift)
    return spring.twist.slope + 3.0 * p[at.CUBIC] * bent * bent + abs(p[at.KAPPA]) + p[at.CREEP_K_1] + p[at.CREEP_K_2]
