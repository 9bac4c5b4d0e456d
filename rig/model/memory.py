"""States with memory, sample by sample: play, Dahl's presliding state, a resonator, followers. Compiled."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]

NO_LAG = 0.01  # of the time between samples


@njit(cache=True, nogil=True)
def play(x: Array, half_width: float) -> Array:
    """Play of `half_width` (unit of x): follows x at a distance, rests when x turns back. Starts at 0, shape (n,)."""
    out = np.empty_like(x)
    y = 0.0
    for i in range(x.size):
        y = min(max(y, x[i] - half_width), x[i] + half_width)
        out[i] = y
    return out


@njit(cache=True, nogil=True)
def follower(x: Array, now: float, before: float, keep: float, state: float) -> Array:
    """y_i = keep·y_{i−1} + now·x_i + before·x_{i−1}, (n,); `state` is keep·y + before·x of the row before the first."""
    out = np.empty_like(x)
    for i in range(x.size):
        out[i] = now * x[i] + state
        state = before * x[i] + keep * out[i]
    return out


@njit(cache=True, nogil=True)
def marched(step: Array, by: Array, by_next: Array, drive: Array, start: Array) -> Array:
    """States (n, 2) from `start` on: each is `step` (2, 2) of the one before, and `by` and `by_next` (2,) times the
    drive (n,) of that row and of its own."""
    out = np.empty((drive.size, 2))
    a, b = start[0], start[1]
    for i in range(drive.size):
        out[i, 0], out[i, 1] = a, b
        if i + 1 < drive.size:
            u, v = drive[i], drive[i + 1]
            a, b = (
                step[0, 0] * a + step[0, 1] * b + by[0] * u + by_next[0] * v,
                step[1, 0] * a + step[1, 1] * b + by[1] * u + by_next[1] * v,
            )
    return out


def lagged(x: Array, lag: float, dt: float) -> Array:
    """`x` (n,) through a first-order lag of `lag` s, begun in steady state, `x` a straight line between samples. As it
    is where the lag is nothing beside the time `dt` [s] between them."""
    if lag < NO_LAG * dt:
        return x
    keep = math.exp(-dt / lag)
    late = lag / dt * (1.0 - keep)
    return np.asarray(follower(np.ascontiguousarray(x), 1.0 - late, late - keep, keep, float(x[0]) * late))


@njit(cache=True, nogil=True)
def presliding(theta: Array, x0: float, start: float = 0.0, springs_back: bool = False, back: float = 1.0) -> Array:
    """Dahl's state z, dz/dθ = (1 − z·sgn ω)/x0, from −1 to 1, exact for any step, from `start` on; shape (n,). One that
    `springs_back` does so as a spring, dz/dθ = 1/x0 until it has let go, as Bouc's and Wen's [wen1976]. On the way
    `back` it takes as many times x0.

    Where it turns back between two samples it has gone further than either says: to the top of the parabola through
    three of them. Of a way of milliradians that is a twentieth.
    """
    out = np.empty_like(theta)
    z, last = start, theta[0] if theta.size else 0.0
    for i in range(theta.size):
        here, top, late = theta[i], theta[i], False
        if 0 < i < theta.size - 1:
            before, after = theta[i - 1], theta[i + 1]
            bend = before - 2.0 * here + after
            if (here - before) * (after - here) < 0.0 and bend != 0.0:
                aside = 0.5 * (before - after) / bend
                top, late = here - 0.25 * (before - after) * aside, aside > 0.0
        if not late:
            z = _slid(z, top - last, x0 if top > last else back * x0, springs_back)
            last = top
        z = _slid(z, here - last, x0 if here > last else back * x0, springs_back)
        out[i] = z
        last = here
        if late:
            z = _slid(z, top - last, x0 if top > last else back * x0, springs_back)
            last = top
    return out


@njit(cache=True, nogil=True)
def _slid(z: float, moved: float, x0: float, springs_back: bool) -> float:
    """The state after `moved` more."""
    if moved == 0.0:
        return z
    way = math.copysign(1.0, moved)
    if springs_back and z * way < 0.0:
        if abs(moved) <= abs(z) * x0:
            return z + moved / x0
        moved, z = moved + z * x0, 0.0
    return way + (z - way) * math.exp(-abs(moved) / x0)


def resonated(x: Array, dt: float, omega: float, zeta: float) -> Array:
    """x through ω²/(s² + 2ζωs + ω²), x linear between samples dt [s] apart, exact; starts in balance with x[0]."""
    return resonance(x, dt, omega, zeta)[0]


@njit(cache=True, nogil=True)
def resonance(
    x: Array, dt: float, omega: float, zeta: float, behind: float = 0.0, rate: float = 0.0
) -> tuple[Array, Array]:
    """`resonated` and its second derivative, both shapes (n,), from where it is `behind` x[0] by that much and changes
    at that `rate` [1/s].

    The state is how far the output is behind: e = y − x and its rate.
    """
    out, second = np.empty_like(x), np.zeros_like(x)
    if x.size == 0:
        return out, second
    sigma = zeta * omega
    wd = omega * math.sqrt(1.0 - zeta * zeta)
    decay, c, s = math.exp(-sigma * dt), math.cos(wd * dt), math.sin(wd * dt)
    by_e, by_v = decay * (c + sigma / wd * s), decay * s / wd
    rate_by_e, rate_by_v = -decay * omega * omega / wd * s, decay * (c - sigma / wd * s)
    # with a ramp of slope r as input, e = y − (x − 2ζr/ω) decays freely: from row to row e and its rate v alone go
    # into the next ones, and the processor waits for nothing else
    e, v, slope = behind, rate, 0.0
    late = 2.0 * zeta / omega
    out[0] = x[0] + e
    for i in range(1, x.size):
        before, slope = slope, (x[i] - x[i - 1]) / dt
        e, v = e + late * (slope - before), v - (slope - before)
        e, v = by_e * e + by_v * v, rate_by_e * e + rate_by_v * v
        out[i] = x[i] - late * slope + e
        second[i] = omega * omega * (x[i] - out[i]) - 2.0 * sigma * (slope + v)
    return out, second
