"""The compiled inner loop of the plant: equations 6-7 with true sticking, fourth-order steps, events inside a step.

Everything compiled stands in this one file: numba's disk cache looks at the file a function is written in, so a
function taken from another file would go stale unseen. With numba switched off the same source runs as plain Python.

Substeps. Explicit Runge-Kutta turns wrong in silence before it turns infinite, so each substep keeps within a bound on
every rate: C_MODE on the fastest linear one, C_ORDER on the angle of the highest order, C_STRIBECK on falling friction.
What that leaves, as the largest error of θ_m/N − θ_l [rad] and of τ_l [N·m] at 1 kHz on the rig of benches/twin.toml
(a count of its load encoder is 7e-6 rad, a step of its torque sensor 1.5e-3 N·m):

    starting at                       as chosen       half            a quarter       against
    9.6 rpm, torque step, 1 s         7e-9   5e-5     4e-10  3e-6     3e-11  2e-7     DOP853 on the Lagrangian's forces
    120 rpm                           8e-9   5e-5     5e-10  3e-6     3e-11  2e-7     DOP853
    300 rpm                           1e-9   7e-6     8e-11  5e-7     7e-12  5e-8     DOP853
    500 rpm                           2e-10  1e-6     1e-11  9e-8     1e-12  8e-9     DOP853
    both sides reversing, 2 s         1e-8   1e-4     9e-10  7e-6     6e-11  4e-7     substeps a 64th as long
    stick and slip, 2 s               9e-8   4e-4     5e-9   2e-5     3e-10  2e-6     substeps a 64th as long

Not looked for: a speed that touches zero, or a held torque that touches its limit, and turns back within one substep.
Friction would have held, or let go, for less than that substep.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

Vector = npt.NDArray[np.float64]
Pair = tuple[float, float]  # (θ̃_p, θ̃_p′), or (motor, load)
Three = tuple[float, float, float]
Four = tuple[float, float, float, float]  # θ_m, ω_m, θ_l, ω_l; or sides and friction
Five = tuple[float, float, float, float, float]
Rates = tuple[float, float, float, float, float, float, float]
Attempt = tuple[bool, Four, Pair, Three, float, Five, float]

# Places in the parameter vector: PER_ is one over it, a product being quicker than a quotient. The Fourier coefficients
# (a_n, b_n, n·a_n, n·b_n) follow from SERIES on.
PER_N, PER_J_M, PER_J_L, K, B_M, B_L, B_ML, B_SP, SIGMA, TAU_C, TAU_S, PER_OMEGA_S, F_CL = range(13)
T_DRIVE, T_SENSOR, WANDER, T_WANDER, MODE_RATE, TERMS, REFINE, SERIES = range(13, 21)

# Places in the state vector. Wander is relative. The last eight are the energy ledger [J].
THETA_M, OMEGA_M, THETA_L, OMEGA_L, TAU_M, TAU_L, FILTERED, WANDER_M, WANDER_L, VALUE, SLOPE, RATE = range(12)
IN_MOTOR, IN_EXTERNAL, LOST_B_M, LOST_B_L, LOST_B_ML, LOST_B_SP, LOST_MOTOR, LOST_LOAD, STATE_SIZE = range(12, 21)

FINE, NOT_FINITE, TOO_FAST, CHATTER = range(4)  # what `advance` reports

C_MODE = 0.16  # rad of the torsional mode per substep
C_ORDER = 0.32  # rad of the highest order of the kinematic error per substep
C_STRIBECK = 0.1  # of the time in which falling friction makes the speed grow e-fold
H_LEAST = 1e-7  # s; a state that needs less has run away: 15 orders at 10^5 rad/s
MOST_EVENTS = 10_000  # in one call; stick and slip cannot alternate that often
H_SLOPE = 1e-9  # s; across less, the slope of the shaft torque would be rounding: the last one stays
STEEPEST = math.sqrt(0.5)  # ω/ω_s where the Stribeck curve falls most
HALVINGS = 45  # of a substep, to find an event in it to the last digits


@njit(cache=True)
def kinematic_error(theta: float, p: Vector) -> Pair:
    """θ̃_p and dθ̃_p/dθ_m by the recurrence c_{n+1} = 2·c_1·c_n − c_{n−1}      [ghorbel2001, Eq. 8]"""
    c, s = math.cos(theta), math.sin(theta)
    twice, c_last, s_last = 2.0 * c, 1.0, 0.0
    value, slope = 0.0, 0.0
    place = SERIES
    for _ in range(int(p[TERMS])):
        value += p[place] * c + p[place + 1] * s
        slope += p[place + 3] * c - p[place + 2] * s
        c, c_last = twice * c - c_last, c
        s, s_last = twice * s - s_last, s
        place += 4
    return value, slope


@njit(cache=True)
def couplings(y: Four, series: Pair, p: Vector) -> Four:
    """Torque of the gear on motor and load, and the powers lost in B_ml and B_sp      [ghorbel2001, Eqs. 5-7]

    φ = θ_l − θ_m/N + θ̃_p,  S = K·φ + B_sp·φ̇,  M = B_ml·(ω_m + σ·ω_l):  −S·(θ̃_p′ − 1/N) − M and −S − σ·M
    """
    theta_m, omega_m, theta_l, omega_l = y
    lever = series[1] - p[PER_N]
    phi_rate = omega_l + lever * omega_m
    spring = p[K] * (theta_l - theta_m * p[PER_N] + series[0]) + p[B_SP] * phi_rate
    slip = omega_m + p[SIGMA] * omega_l
    mesh = p[B_ML] * slip
    return -spring * lever - mesh, -spring - p[SIGMA] * mesh, mesh * slip, p[B_SP] * phi_rate**2


@njit(cache=True)
def stribeck(omega_m: float, p: Vector) -> float:
    """τ_c + (τ_s − τ_c)·exp(−(ω/ω_s)²), before the wander      [armstrong1994]"""
    x = omega_m * p[PER_OMEGA_S]
    return p[TAU_C] + (p[TAU_S] - p[TAU_C]) * math.exp(-x * x)


@njit(cache=True)
def rates(y: Four, series: Pair, torque: Pair, grip: Four, p: Vector) -> Rates:
    """Accelerations, then the powers lost in B_m, B_l, B_ml, B_sp and the motor's friction      [ghorbel2001, Eqs. 6-7]

    `torque`: motor, external. `grip`: which way each side slides (0: it is held), relative friction of the motor,
    friction torque of the load.
    """
    side_m, side_l, level_m, friction_l = grip
    on_motor, on_load, lost_ml, lost_sp = couplings(y, series, p)
    friction_m = side_m * level_m * stribeck(y[1], p)
    a_m = p[PER_J_M] * (torque[0] + on_motor - p[B_M] * y[1] - friction_m) if side_m != 0.0 else 0.0
    a_l = p[PER_J_L] * (torque[1] + on_load - p[B_L] * y[3] - side_l * friction_l) if side_l != 0.0 else 0.0
    return a_m, a_l, p[B_M] * y[1] ** 2, p[B_L] * y[3] ** 2, lost_ml, lost_sp, friction_m * y[1]


@njit(cache=True)
def step(
    y: Four, k1: Rates, h: float, torque: Pair, lag: float, grip: Four, p: Vector
) -> tuple[Four, Five, float, float]:
    """One step of the classical fourth-order Runge-Kutta method; each side keeps sliding, or held, as it is.

    The drive's torque τ + lag·e^{−t/T} changes too fast for it. What `lag` does to a free motor is therefore integrated
    exactly, v = lag·T/J_m·(1 − e^{−t/T}) in speed and x = ∫v in angle, and the method sees the slow rest, w = ω_m − v.
    `k1` is `rates` at `y` without the lag. Gives the new angles and speeds, the energies lost as listed in `rates`,
    the work of the motor, and what share of the lag is left.
    """
    theta_m, w, theta_l, u = y
    half = math.exp(-0.5 * h / p[T_DRIVE])
    kick = lag * p[T_DRIVE] * p[PER_J_M] if grip[0] != 0.0 else 0.0
    v2, v4 = kick * (1.0 - half), kick * (1.0 - half * half)
    x2, x4 = kick * 0.5 * h - v2 * p[T_DRIVE], kick * h - v4 * p[T_DRIVE]
    w2, u2 = w + 0.5 * h * k1[0], u + 0.5 * h * k1[1]
    y2 = (theta_m + 0.5 * h * w + x2, w2 + v2, theta_l + 0.5 * h * u, u2)
    k2 = rates(y2, kinematic_error(y2[0], p), torque, grip, p)
    w3, u3 = w + 0.5 * h * k2[0], u + 0.5 * h * k2[1]
    y3 = (theta_m + 0.5 * h * w2 + x2, w3 + v2, theta_l + 0.5 * h * u2, u3)
    k3 = rates(y3, kinematic_error(y3[0], p), torque, grip, p)
    w4, u4 = w + h * k3[0], u + h * k3[1]
    y4 = (theta_m + h * w3 + x4, w4 + v4, theta_l + h * u3, u4)
    k4 = rates(y4, kinematic_error(y4[0], p), torque, grip, p)
    s = h / 6.0
    travel = s * (w + 2.0 * (w2 + w3) + w4) + x4
    gain = s * (k1[0] + 2.0 * (k2[0] + k3[0]) + k4[0])
    end = (
        theta_m + travel,
        w + gain + v4,
        theta_l + s * (u + 2.0 * (u2 + u3) + u4),
        u + s * (k1[1] + 2.0 * (k2[1] + k3[1]) + k4[1]),
    )
    lost = (
        s * (k1[2] + 2.0 * (k2[2] + k3[2]) + k4[2]),
        s * (k1[3] + 2.0 * (k2[3] + k3[3]) + k4[3]),
        s * (k1[4] + 2.0 * (k2[4] + k3[4]) + k4[4]),
        s * (k1[5] + 2.0 * (k2[5] + k3[5]) + k4[5]),
        s * (k1[6] + 2.0 * (k2[6] + k3[6]) + k4[6]),
    )
    work = torque[0] * travel + 0.5 * v4 * v4 / p[PER_J_M]
    if kick != 0.0:  # ∫ lag·e^{−t/T}·w dt with w a parabola
        x, keep = h / p[T_DRIVE], half * half
        first = (1.0 - keep * (1.0 + x)) / x
        second = (2.0 - keep * (2.0 + x * (2.0 + x))) / (x * x)
        work += kick / p[PER_J_M] * (w * (1.0 - keep) + h * k1[0] * first + (gain - h * k1[0]) * second)
    return end, lost, work, half * half


@njit(cache=True)
def balance(y: Four, series: Pair, tau_m: float, tau_ext: float, p: Vector) -> Three:
    """Net torque on motor and load before friction, and τ_l, all the gear gives to the load [N·m]."""
    on_motor, on_load, _, _ = couplings(y, series, p)
    return tau_m + on_motor - p[B_M] * y[1], tau_ext + on_load - p[B_L] * y[3], on_load


@njit(cache=True)
def way(omega: float, net: float, hold: float) -> float:
    """Which way a side slides: ±1, or 0 at rest where `hold` N·m of friction can keep it      [karnopp1985]"""
    if omega == 0.0:
        return 0.0 if abs(net) <= hold else math.copysign(1.0, net)
    return math.copysign(1.0, omega)


@njit(cache=True)
def turned(side: float, omega: float, net: float, hold: float) -> bool:
    """Whether a side no longer does what it did: a sliding one came to rest, a held one broke away."""
    return abs(net) > hold if side == 0.0 else side * omega < 0.0


@njit(cache=True)
def attempt(y: Four, k1: Rates, h: float, torque: Pair, lag: float, grip: Four, hold: Pair, p: Vector) -> Attempt:
    """A step, the state after it, and whether an event lies inside it."""
    end, lost, work, keep = step(y, k1, h, torque, lag, grip, p)
    series_end = kinematic_error(end[0], p)
    net = balance(end, series_end, torque[0] + lag * keep, torque[1], p)
    event = turned(grip[0], end[1], net[0], hold[0]) or turned(grip[1], end[3], net[1], hold[1])
    return event, end, series_end, net, keep, lost, work


@njit(cache=True)
def locate(y: Four, k1: Rates, h: float, torque: Pair, lag: float, grip: Four, hold: Pair, p: Vector) -> float:
    """Time [s] of the first event inside a step of `h`, from just behind it, by bisection."""
    before, after = 0.0, h
    for _ in range(HALVINGS):
        middle = 0.5 * (before + after)
        if attempt(y, k1, middle, torque, lag, grip, hold, p)[0]:
            after = middle
        else:
            before = middle
    return after


@njit(cache=True)
def halted(y: Four, grip: Four) -> Four:
    """`y` with a speed of exactly zero where a sliding side has just come to rest."""
    return y[0], 0.0 if grip[0] * y[1] < 0.0 else y[1], y[2], 0.0 if grip[1] * y[3] < 0.0 else y[3]


@njit(cache=True)
def longest_substep(omega_m: float, most_a: float, grip: Four, p: Vector) -> float:
    """The longest substep [s] every rate allows, wherever an acceleration of `most_a` takes the speed."""
    h = C_MODE / p[MODE_RATE]
    if grip[0] == 0.0:
        return h / p[REFINE]
    angle, speed = C_ORDER / p[TERMS], abs(omega_m)  # the motor may go through `angle`: speed·h + a·h² at most
    reach = speed + math.sqrt(speed * speed + 4.0 * most_a * angle)
    if reach * h > 2.0 * angle:
        h = 2.0 * angle / reach
    x = max((speed - most_a * h) * p[PER_OMEGA_S], STEEPEST)
    growth = 2.0 * grip[2] * (p[TAU_S] - p[TAU_C]) * x * math.exp(-x * x) * p[PER_OMEGA_S] * p[PER_J_M]
    if growth * h > C_STRIBECK:
        h = C_STRIBECK / growth
    return h / p[REFINE]


@njit(cache=True)
def wandered(x: float, dt: float, xi: float, p: Vector) -> float:
    """Ornstein-Uhlenbeck process after `dt` s, exact for any `dt`; `xi` from the standard normal distribution."""
    keep = math.exp(-dt / p[T_WANDER])
    return keep * x + p[WANDER] * math.sqrt(1.0 - keep * keep) * xi


@njit(cache=True)
def low_passed(filtered: float, start: float, end: float, h: float, p: Vector) -> float:
    """First-order low-pass after `h` s while its input went straight from `start` to `end`, exact."""
    lag = (end - start) / h * p[T_SENSOR]
    return end - lag + (filtered - start + lag) * math.exp(-h / p[T_SENSOR])


@njit(cache=True)
def book(state: Vector, lost: Five, work: float, external: float, friction_l: float) -> None:
    """Enter one substep's energies [J] in the ledger."""
    state[IN_MOTOR] += work
    state[IN_EXTERNAL] += external
    state[LOST_B_M] += lost[0]
    state[LOST_B_L] += lost[1]
    state[LOST_B_ML] += lost[2]
    state[LOST_B_SP] += lost[3]
    state[LOST_MOTOR] += lost[4]
    state[LOST_LOAD] += friction_l


@njit(cache=True)
def advance(
    state: Vector, p: Vector, dt: float, tau: float, tau_ext: float, locked: bool, xi_m: float, xi_l: float
) -> tuple[int, Three, Three, Four]:
    """Let `dt` s pass with `tau` N·m commanded and `tau_ext` N·m on the load; friction wanders once, before it.

    Gives (status, (θ_m, ω_m, ω̇_m), (θ_l, ω_l, ω̇_l), (τ_m, τ_l, τ̇_l, low-passed τ_l)); `state` follows unless it failed.
    """
    wander_m, wander_l = wandered(state[WANDER_M], dt, xi_m, p), wandered(state[WANDER_L], dt, xi_l, p)
    level_m, friction_l = max(0.0, 1.0 + wander_m), max(0.0, 1.0 + wander_l) * p[F_CL]  # friction never pushes
    hold = (level_m * p[TAU_S], math.inf if locked else friction_l)
    y = (state[THETA_M], state[OMEGA_M], state[THETA_L], state[OMEGA_L])
    series, filtered = (state[VALUE], state[SLOPE]), state[FILTERED]
    torque, lag = (tau, tau_ext), state[TAU_M] - tau
    net = balance(y, series, state[TAU_M], tau_ext, p)
    left, rate, events, status = dt, state[RATE], 0, FINE
    while True:
        grip = (way(y[1], net[0], hold[0]), way(y[3], net[1], hold[1]), level_m, friction_l)
        k1 = rates(y, series, torque, grip, p)
        a_m = k1[0] + (lag * p[PER_J_M] if grip[0] != 0.0 else 0.0)
        if left <= 0.0:
            break
        h = left
        if grip[0] != 0.0 or grip[1] != 0.0:
            most = longest_substep(y[1], max(abs(a_m), abs(k1[0])), grip, p)  # before and behind the drive's lag
            if not most >= H_LEAST:
                status = TOO_FAST
                break
            if most < left:
                h = left / math.ceil(left / most - 1e-9)
        event, end, series_end, net_end, keep, lost, work = attempt(y, k1, h, torque, lag, grip, hold, p)
        if event:
            h, events = locate(y, k1, h, torque, lag, grip, hold, p), events + 1
            event, end, series_end, net_end, keep, lost, work = attempt(y, k1, h, torque, lag, grip, hold, p)
            end = halted(end, grip)
            net_end = balance(end, series_end, tau + lag * keep, tau_ext, p)
        if not math.isfinite(end[0] + end[1] + end[2] + end[3] + net_end[0]):
            status = NOT_FINITE
            break
        if p[TERMS] * abs(end[1]) * h > 2.0 * C_ORDER:  # what pushed it came up inside the substep, unforeseen
            status = TOO_FAST
            break
        if events > MOST_EVENTS:
            status = CHATTER
            break
        travel_l = end[2] - y[2]
        book(state, lost, work, tau_ext * travel_l, grip[1] * friction_l * travel_l)
        filtered = low_passed(filtered, net[2], net_end[2], h, p)
        if h > H_SLOPE:
            rate = (net_end[2] - net[2]) / h
        lag *= keep
        left = 0.0 if h == left else left - h
        y, series, net = end, series_end, net_end
    if status == FINE:
        state[THETA_M], state[OMEGA_M], state[THETA_L], state[OMEGA_L] = y
        state[TAU_M], state[TAU_L], state[FILTERED] = tau + lag, net[2], filtered
        state[WANDER_M], state[WANDER_L] = wander_m, wander_l
        state[VALUE], state[SLOPE], state[RATE] = series[0], series[1], rate
    return status, (y[0], y[1], a_m), (y[2], y[3], k1[1]), (tau + lag, net[2], rate, filtered)
