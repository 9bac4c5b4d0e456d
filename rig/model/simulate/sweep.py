"""Many gears under one torque at once, for studies that draw their gears by the thousand: parameters innermost.

One number of each gear stands beside the same number of its neighbours, so that a register of the processor holds
four or eight gears and works on all of them with one instruction; a gear by itself costs ten times as much. So that the
compiler can do that, everything a block of gears needs lies in one flat array at fixed offsets, no loop has a branch
(nor the one that would raise for a division by zero: error_model), and sine, cosine and e^{−x²} are polynomials: a call
of the C library would be made gear by gear.

Fourth-order Runge-Kutta, in substeps within the twin's bounds on every rate. A side that stops does so at the end of a
substep, as in `march`, without whose ledger of energy this does: each reversal comes up to 50 µs late.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit, prange

from rig.model.gear import Gear
from rig.model.linear import natural_frequency
from rig.model.simulate.waveform import Array

LANES = 32  # gears in a block: its numbers and its series fit the nearest cache
MODE, ORDER = (
    0.16,
    0.32,
)  # rad of the torsional mode, and of the highest order, a substep: as in sim/kernel
STRIBECK, STEEPEST, FLAT = 0.1, 0.858, 3.0  # of the e-fold of falling friction a substep; max 2x·e^{−x²}; x without
STOP = 5e-5  # s a substep near a stop: so late at most does a reversal begin
HARMLESS = {"contract", "nsz", "arcp", "reassoc"}  # of fastmath: NaN stays NaN

# Rows of a block's numbers: state, state within a substep, what follows from it, sums of the Runge-Kutta rule.
THETA_M, OMEGA_M, THETA_L, OMEGA_L = (row * LANES for row in range(4))
TH, W, TL, U, A_M, A_L, NET_M, NET_L, SIDE_M, SIDE_L, BELL, COS, SIN = (row * LANES for row in range(4, 17))
VALUE, VALUE_IM, SLOPE, SLOPE_IM, SUM_TH, SUM_W, SUM_TL, SUM_U = (row * LANES for row in range(17, 25))
# Its parameters, and behind them its series: (a_n, b_n, n·b_n, n·a_n) from the highest order down.
NAMES = ("ratio", "J_m", "J_l", "K", "B_m", "B_l", "B_ml", "B_sp", "sigma", "tau_c", "tau_s", "omega_s", "F_cl")
N, J_M, J_L, K, B_M, B_L, B_ML, B_SP, SIGMA, TAU_C, TAU_S, OMEGA_S, F_CL = (row * LANES for row in range(25, 38))
SERIES = 38 * LANES

TWO_OVER_PI = 2.0 / math.pi
HALF_PI, HALF_PI_REST = 1.5707963267341256, 6.077100506506192e-11  # π/2: 33 bits, so that a multiple is exact; the rest
SQUARINGS, FARTHEST = 8, 45.0  # e^{−45} = 3e-20: friction has reached τ_c to the last digit


class Swept(NamedTuple):
    """All (gears, n) at the times asked for; SI. NaN: that gear moved too fast to be followed."""

    theta_m: Array
    omega_m: Array
    theta_l: Array
    omega_l: Array


def each_under_torque(
    gears: Sequence[Gear], t: Array, tau: Array, tau_ext: float = 0.0, start: Array | None = None
) -> Swept:
    """Equations 6-7 for every gear under the motor torque `tau` [N·m], held from each time of `t` [s, rising] to the
    next; both (n,). Friction as in `under_torque`      [ghorbel2001, Eqs. 6-7] [karnopp1985]

    `start`: θ_m, ω_m, θ_l, ω_l of each gear, (4, gears); without it at rest, the spring relaxed. Gears of one block of
    32 share their substeps: a neighbour shows within the error of the rule, at most 3e-6 of the motor's way.
    """
    blocks = _blocks(list(gears), start)
    slowest = MODE / max(_fastest_rate(gear) for gear in gears)
    out = np.empty((len(blocks), 4 * LANES, len(t)))
    top = (blocks.shape[1] - SERIES) // (4 * LANES)
    _sweep(blocks, np.asarray(t, float), np.asarray(tau, float), tau_ext, slowest, ORDER / top, out)
    by_gear = out.reshape(len(blocks), 4, LANES, len(t)).transpose(1, 0, 2, 3).reshape(4, -1, len(t))
    return Swept(*by_gear[:, : len(gears)])


def _blocks(gears: list[Gear], start: Array | None) -> Array:
    """All numbers of blocks of gears, (blocks, rows·LANES); the last is filled up with its last gear."""
    filled = [*gears, *[gears[-1]] * (-len(gears) % LANES)]
    if start is None:
        rest = [-float(g.kinematic_error.value(np.zeros(()))) for g in gears]
        start = np.stack([np.zeros(len(gears)), np.zeros(len(gears)), np.array(rest), np.zeros(len(gears))])
    terms = max(max(len(g.kinematic_error.a) for g in gears), 1)
    rows = np.zeros((SERIES // LANES + 4 * terms, len(filled)))
    rows[:4] = np.concatenate([start, np.repeat(start[:, -1:], len(filled) - len(gears), axis=1)], axis=1)
    rows[N // LANES : SERIES // LANES] = [[getattr(g, name) for g in filled] for name in NAMES]
    series = rows[SERIES // LANES :].reshape(terms, 4, -1)[::-1]
    for i, g in enumerate(filled):
        a, b, n = np.asarray(g.kinematic_error.a), np.asarray(g.kinematic_error.b), g.kinematic_error.orders
        series[: len(n), :, i] = np.stack([a, b, n * b, n * a], axis=1)
    cut = rows.reshape(len(rows), -1, LANES).transpose(1, 0, 2)
    return np.ascontiguousarray(cut).reshape(cut.shape[0], -1)


def _fastest_rate(gear: Gear) -> float:
    """1/s: the torsional mode's frequency, or the drag of either side."""
    return max(natural_frequency(gear), (gear.B_m + gear.B_ml) / gear.J_m, (gear.B_l + gear.B_ml) / gear.J_l)


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _circle(z: Array) -> None:
    """cos θ and sin θ by Taylor's series around the nearest multiple of π/2, to 1e-15 there."""
    for i in range(LANES):
        k = math.floor(z[TH + i] * TWO_OVER_PI + 0.5)
        r = (z[TH + i] - k * HALF_PI) - k * HALF_PI_REST
        q = r * r
        s = 1 + q * (-1 / 6 + q * (1 / 120 + q * (-1 / 5040 + q * (1 / 362880 + q * (-1 / 39916800 + q / 6227020800)))))
        s = r * (s - q**7 / 1307674368000)
        c = 1 / 40320 + q * (-1 / 3628800 + q * (1 / 479001600 - q / 87178291200))
        c = 1 + q * (-1 / 2 + q * (1 / 24 + q * (-1 / 720 + q * c)))
        odd = k - 2.0 * math.floor(0.5 * k)  # an odd quarter of the circle: sine and cosine change places
        turned_s, turned_c = math.floor(0.5 * k), math.floor(0.5 * (k + 1.0))  # and signs every half
        z[SIN + i] = (1.0 - 2.0 * (turned_s - 2.0 * math.floor(0.5 * turned_s))) * (s + odd * (c - s))
        z[COS + i] = (1.0 - 2.0 * (turned_c - 2.0 * math.floor(0.5 * turned_c))) * (c + odd * (s - c))


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _error(z: Array) -> None:
    """θ̃_p and θ̃_p′: Horner's rule in e^{jθ}, from the highest order down      [ghorbel2001, Eq. 8]"""
    for i in range(LANES):
        z[VALUE + i] = z[VALUE_IM + i] = z[SLOPE + i] = z[SLOPE_IM + i] = 0.0
    for at in range(SERIES, z.size, 4 * LANES):
        term = z[at : at + 4 * LANES]
        for i in range(LANES):
            c, s = z[COS + i], z[SIN + i]
            x, y = z[VALUE + i] + term[i], z[VALUE_IM + i] - term[LANES + i]
            u, v = z[SLOPE + i] + term[2 * LANES + i], z[SLOPE_IM + i] + term[3 * LANES + i]
            z[VALUE + i], z[VALUE_IM + i] = x * c - y * s, x * s + y * c
            z[SLOPE + i], z[SLOPE_IM + i] = u * c - v * s, u * s + v * c


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _torques(tau: float, tau_ext: float, z: Array) -> None:
    """On motor and load but for dry friction, and e^{−(ω/ω_s)²} = (e^{−(ω/ω_s)²/256})^256."""
    for i in range(LANES):
        lever = 1.0 / z[N + i] - z[SLOPE + i]
        rate = z[U + i] - lever * z[W + i]
        spring = z[K + i] * (z[TL + i] - z[TH + i] / z[N + i] + z[VALUE + i]) + z[B_SP + i] * rate
        mesh = z[B_ML + i] * (z[W + i] + z[SIGMA + i] * z[U + i])
        z[NET_M + i] = tau + spring * lever - mesh - z[B_M + i] * z[W + i]
        z[NET_L + i] = tau_ext - spring - z[SIGMA + i] * mesh - z[B_L + i] * z[U + i]
        x = z[W + i] / z[OMEGA_S + i]
        y = -min(x * x, FARTHEST) / 2.0**SQUARINGS
        e = 1 + y * (1 + y * (1 / 2 + y * (1 / 6 + y * (1 / 24 + y * (1 / 120 + y * (1 / 720 + y / 5040))))))
        for _ in range(SQUARINGS):
            e *= e
        z[BELL + i] = e


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _way(omega: float, net: float, hold: float) -> float:
    """±1 for the way a side slides, 0 where friction holds it      [karnopp1985]"""
    driven = math.copysign(1.0, net) if abs(net) > hold else 0.0
    return math.copysign(1.0, omega) if omega != 0.0 else driven


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _accelerate(z: Array) -> None:
    """Accelerations of both sides, each sliding as SIDE says      [armstrong1994]"""
    for i in range(LANES):
        rub = z[TAU_C + i] + (z[TAU_S + i] - z[TAU_C + i]) * z[BELL + i]
        slides_m, slides_l = abs(z[SIDE_M + i]), abs(z[SIDE_L + i])
        z[A_M + i] = slides_m * (z[NET_M + i] - z[SIDE_M + i] * rub) / z[J_M + i]
        z[A_L + i] = slides_l * (z[NET_L + i] - z[SIDE_L + i] * z[F_CL + i]) / z[J_L + i]


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _add(weight: float, ahead: float, z: Array) -> None:
    """A stage's rates, `weight` s of them into the sums; then the state `ahead` s beyond the substep's start."""
    for i in range(LANES):
        w, u, a_m, a_l = z[W + i], z[U + i], z[A_M + i], z[A_L + i]
        z[SUM_TH + i] += weight * w
        z[SUM_W + i] += weight * a_m
        z[SUM_TL + i] += weight * u
        z[SUM_U + i] += weight * a_l
        z[TH + i], z[W + i] = z[THETA_M + i] + ahead * w, z[OMEGA_M + i] + ahead * a_m
        z[TL + i], z[U + i] = z[THETA_L + i] + ahead * u, z[OMEGA_L + i] + ahead * a_l


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _begin(z: Array) -> None:
    """The substep's start as its first stage."""
    for i in range(4 * LANES):
        z[TH + i] = z[THETA_M + i]
    for i in range(4 * LANES):
        z[SUM_TH + i] = z[THETA_M + i]


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _take_sides(z: Array) -> None:
    """Which way each side slides throughout the substep."""
    for i in range(LANES):
        z[SIDE_M + i] = _way(z[W + i], z[NET_M + i], z[TAU_S + i])
        z[SIDE_L + i] = _way(z[U + i], z[NET_L + i], z[F_CL + i])


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _end(fastest: float, z: Array) -> None:
    """Friction ends a motion, it does not turn it round; beyond `fastest` rad/s nothing more is known of a gear."""
    for i in range(LANES):
        w, u = z[SUM_W + i], z[SUM_U + i]
        known = abs(w) <= fastest
        z[THETA_M + i] = z[SUM_TH + i] if known else math.nan
        z[OMEGA_M + i] = (w if w * z[SIDE_M + i] > 0.0 else 0.0) if known else math.nan
        z[THETA_L + i] = z[SUM_TL + i] if known else math.nan
        z[OMEGA_L + i] = (u if u * z[SIDE_L + i] > 0.0 else 0.0) if known else math.nan


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _substep(h: float, fastest: float, tau: float, tau_ext: float, z: Array) -> None:
    """Of `h` s, by the classical fourth-order rule."""
    _begin(z)
    for stage, (weight, ahead) in enumerate(((h / 6.0, 0.5 * h), (h / 3.0, 0.5 * h), (h / 3.0, h), (h / 6.0, 0.0))):
        _circle(z)
        _error(z)
        _torques(tau, tau_ext, z)
        if stage == 0:
            _take_sides(z)
        _accelerate(z)
        _add(weight, ahead, z)
    _end(fastest, z)


@njit(cache=True, fastmath=HARMLESS, error_model="numpy")
def _rate(longest: float, angle: float, z: Array) -> float:
    """What the fastest change in the block asks of the next substep [1/s]: the mode, the series, falling friction."""
    fastest = 1.0 / longest
    for i in range(LANES):
        speed = abs(z[OMEGA_M + i])
        slowing = (speed - abs(z[A_M + i]) * longest) / z[OMEGA_S + i]
        falls = STEEPEST * (z[TAU_S + i] - z[TAU_C + i]) / (z[OMEGA_S + i] * z[J_M + i]) / STRIBECK
        stops = max(falls, 1.0 / STOP) if speed > 0.0 else falls
        fastest = max(fastest, max(speed / angle, stops if slowing < FLAT else 0.0))
    return fastest


@njit(cache=True)
def _keep(z: Array, k: int, out: Array) -> None:
    """The states of a block as column `k`; value by value, which compiles in a fraction of the time of a slice."""
    for i in range(4 * LANES):
        out[i, k] = z[i]


@njit(cache=True, parallel=True, error_model="numpy")
def _sweep(blocks: Array, t: Array, tau: Array, tau_ext: float, longest: float, angle: float, out: Array) -> None:
    """Block by block, each on one core: `out` (blocks, 4·LANES, n). `longest` s a substep, `angle` rad in it."""
    for block in prange(blocks.shape[0]):
        z = blocks[block].copy()
        _keep(z, 0, out[block])
        for k in range(t.size - 1):
            left = t[k + 1] - t[k]
            while left > 0.0:
                count = math.ceil(left * _rate(longest, angle, z) - 1e-9)
                h = left / count
                _substep(h, 2.0 * angle / h, tau[k], tau_ext, z)
                left = 0.0 if count <= 1 else left - h
            _keep(z, k + 1, out[block])
