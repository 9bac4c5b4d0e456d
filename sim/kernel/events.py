"""What happens inside a substep: a side stops or breaks away, the spring leaves its piece; found by bisection."""

from __future__ import annotations

import math

from numba import njit

from sim.kernel import layout as at
from sim.kernel.friction import breakaway
from sim.kernel.gear import mesh
from sim.kernel.layout import Attempt, Four, Mesh, Point, Rates, Spring, Three, Vector
from sim.kernel.spring import left
from sim.kernel.step import point_at, step


@njit
def balance(y: Four, m: Mesh, tau_m: float, tau_ext: float, p: Vector) -> Three:
    """Net torque on motor and load before friction, and τ_l, all the gear gives to the load [N·m]."""
    return (
        tau_m + m.on_motor + m.aside_m - p[at.B_M] * y[1],
        tau_ext + m.on_load + m.aside_l - p[at.B_L] * y[3],
        m.on_load,
    )


@njit
def way(omega: float, net: float, hold: float) -> float:
    """Which way a side slides: ±1, or 0 at rest where `hold` N·m of friction can keep it      [karnopp1985]"""
    if omega == 0.0:
        return 0.0 if abs(net) <= hold else math.copysign(1.0, net)
    return math.copysign(1.0, omega)


@njit
def turned(side: float, omega: float, net: float, hold: float) -> bool:
    """Whether a side no longer does what it did: a sliding one came to rest, a held one broke away."""
    return abs(net) > hold if side == 0.0 else side * omega < 0.0


@njit
def attempt(
    start: Point,
    k1: Rates,
    h: float,
    outside: Three,
    lag: float,
    grip: Four,
    hold_l: float,
    spring: Spring,
    p: Vector,
) -> Attempt:
    """A step, the state after it, and whether an event lies inside it."""
    y, slow, energies, keep = step(start, k1, h, outside, lag, grip, spring, p)
    end = point_at(y, slow, p)
    m = mesh(y, slow, end.error, (outside[0], outside[1], outside[2] + h), spring, p)
    net = balance(y, m, outside[0] + lag * keep, outside[1], p)
    hold_m = breakaway(y[0], m.elastic, grip[2], slow, p) if grip[0] == 0.0 else 0.0
    turns = turned(grip[0], y[1], net[0], hold_m) or turned(grip[1], y[3], net[1], hold_l)
    event = turns or left(y, m, slow, spring)
    return Attempt(event, end, net, m, keep, energies)


@njit
def locate(
    start: Point,
    k1: Rates,
    h: float,
    outside: Three,
    lag: float,
    grip: Four,
    hold_l: float,
    spring: Spring,
    p: Vector,
) -> float:
    """Time [s] of the first event inside a step of `h`, from just behind it, by bisection."""
    before, after = 0.0, h
    for _ in range(at.HALVINGS):
        middle = 0.5 * (before + after)
        if attempt(start, k1, middle, outside, lag, grip, hold_l, spring, p).event:
            after = middle
        else:
            before = middle
    return after


@njit
def halted(y: Four, grip: Four) -> Four:
    """`y` with a speed of exactly zero where a sliding side has just come to rest."""
    return y[0], 0.0 if grip[0] * y[1] < 0.0 else y[1], y[2], 0.0 if grip[1] * y[3] < 0.0 else y[3]
