"""Time passes: substeps as long as every rate allows, events inside them, the ledger, the slow states."""

from __future__ import annotations

import math

from numba import njit

from sim.kernel import layout as at
from sim.kernel.events import attempt, balance, halted, locate, way
from sim.kernel.friction import breakaway, heat, wandered, warm
from sim.kernel.gear import mesh
from sim.kernel.layout import Energies, Error, Four, Mesh, Pair, Point, Slow, Spring, Three, Vector
from sim.kernel.spring import follow, piece, stiffest
from sim.kernel.step import accelerated

OnPiece = tuple[Mesh, Spring]
Passed = tuple[int, Three, Three, Four]


@njit
def longest_for_the_mode(phi: float, slow: Slow | None, spring: Spring, p: Vector) -> float:
    """What the torsional mode allows [s], as stiff as the spring here is, and the vibration from outside."""
    if slow is None:
        return at.C_MODE / p[at.MODE_RATE]
    stiffer = max(1.0, stiffest(phi, spring, p) / p[at.K]) * p[at.MODE_RATE] ** 2
    h = at.C_MODE / math.sqrt(stiffer + spring.bristles.slope * p[at.PER_J_M])
    return min(h, at.C_ORDER / p[at.SHAKE_RATE]) if p[at.SHAKE_RATE] > 0.0 else h


@njit
def longest_substep(
    omega_m: float, most_a: float, grip: Four, phi: float, slow: Slow | None, spring: Spring, p: Vector
) -> float:
    """The longest substep [s] every rate allows, wherever an acceleration of `most_a` takes the speed."""
    h = longest_for_the_mode(phi, slow, spring, p)
    if grip[0] == 0.0:
        return h / p[at.REFINE]
    angle, speed = at.C_ORDER / p[at.TOP_ORDER], abs(omega_m)  # it may go through `angle`: speed·h + a·h² at most
    reach = speed + math.sqrt(speed * speed + 4.0 * most_a * angle)
    if reach * h > 2.0 * angle:
        h = 2.0 * angle / reach
    x = max((speed - most_a * h) * p[at.PER_OMEGA_S], at.STEEPEST)
    growth = 2.0 * grip[2] * (p[at.TAU_S] - p[at.TAU_C]) * x * math.exp(-x * x) * p[at.PER_OMEGA_S] * p[at.PER_J_M]
    if growth * h > at.C_STRIBECK:
        h = at.C_STRIBECK / growth
    return h / p[at.REFINE]


@njit
def low_passed(filtered: float, start: float, end: float, h: float, p: Vector) -> float:
    """First-order low-pass after `h` s while its input went straight from `start` to `end`, exact."""
    lag = (end - start) / h * p[at.T_SENSOR]
    return end - lag + (filtered - start + lag) * math.exp(-h / p[at.T_SENSOR])


@njit
def book(state: Vector, e: Energies, external: float, friction_l: float) -> None:
    """Enter one substep's energies [J] in the ledger."""
    state[at.IN_MOTOR] += e.work
    state[at.IN_EXTERNAL] += external + e.shake
    state[at.LOST_B_M] += e.lost_m
    state[at.LOST_B_L] += e.lost_l
    state[at.LOST_B_ML] += e.lost_ml
    state[at.LOST_B_SP] += e.lost_sp
    state[at.LOST_MOTOR] += e.friction
    state[at.LOST_LOAD] += friction_l
    state[at.LOST_CREEP] += e.lost_creep
    state[at.IN_SCHEDULE] += e.schedule


@njit
def motor_heat(state: Vector) -> float:
    """What the motor side has turned to heat so far [J]."""
    return state[at.LOST_MOTOR] + state[at.LOST_B_M] + state[at.LOST_B_ML]


@njit
def on_its_piece(here: Point, slow: Slow | None, outside: Three, spring: Spring, state: Vector, p: Vector) -> OnPiece:
    """The gear, and the piece of the spring's law that holds from here on; `spring` has the right torque here."""
    m = mesh(here.y, slow, here.error, outside, spring, p)
    if slow is None:
        return m, spring
    spring = piece(here.y, m.phi, m.phi_rate, slow, state, p)
    return mesh(here.y, slow, here.error, outside, spring, p), spring


@njit
def put_away(slow: Slow | None, state: Vector) -> None:
    """The slow states back to their places."""
    if slow is not None:
        state[at.LOAD_SEEN], state[at.CREEP_1], state[at.CREEP_2] = slow


@njit
def passing(
    state: Vector, p: Vector, dt: float, tau: float, tau_ext: float, locked: bool, xi_m: float, xi_l: float
) -> Passed:
    """`advance_full` of the package: with temperature; the elements are as they were should it fail."""
    before, lost = state.copy(), motor_heat(state)
    warm(state, p)
    slow = Slow(state[at.LOAD_SEEN], state[at.CREEP_1], state[at.CREEP_2])
    found = substeps(state, slow, p, dt, tau, tau_ext, locked, (xi_m, xi_l))
    if found[0] != at.FINE:
        for i in range(state.size):  # of a slice numba compiles for four seconds what would be said if it did not fit
            state[i] = before[i]
    elif dt > 0.0:
        heat(state, p, motor_heat(state) - lost, dt)
    return found


@njit
def beginning(slow: Slow | None, state: Vector) -> Point:
    """Where the state says the rig is."""
    y = (state[at.THETA_M], state[at.OMEGA_M], state[at.THETA_L], state[at.OMEGA_L])
    return Point(y, slow, Error(state[at.VALUE], state[at.SLOPE], state[at.PER_LOAD]))


@njit
def judged(end: Point, net: Three, h: float, events: int, p: Vector) -> int:
    """Whether the plant could be followed through a substep."""
    y = end.y
    if not math.isfinite(y[0] + y[1] + y[2] + y[3] + net[0]):
        return at.NOT_FINITE
    if p[at.TOP_ORDER] * abs(y[1]) * h > 2.0 * at.C_ORDER:  # what pushed it came up inside the substep, unforeseen
        return at.TOO_FAST
    return at.CHATTER if events > at.MOST_EVENTS else at.FINE


@njit
def put_down(here: Point, shaft: Four, wander: Pair, t: float, state: Vector) -> None:
    """The rig back into the state vector; `shaft`: τ_m, τ_l, τ̇_l, low-passed τ_l."""
    state[at.THETA_M], state[at.OMEGA_M], state[at.THETA_L], state[at.OMEGA_L] = here.y
    state[at.TAU_M], state[at.TAU_L], state[at.RATE], state[at.FILTERED] = shaft
    state[at.WANDER_M], state[at.WANDER_L] = wander
    state[at.VALUE], state[at.SLOPE], state[at.PER_LOAD] = here.error
    state[at.CLOCK] = t
    put_away(here.slow, state)


@njit
def substeps(
    state: Vector, slow: Slow | None, p: Vector, dt: float, tau: float, tau_ext: float, locked: bool, xi: Pair
) -> Passed:
    """Friction wanders once, then substeps until `dt` s are over; `state` follows unless it failed."""
    wander_m, wander_l = wandered(state[at.WANDER_M], dt, xi[0], p), wandered(state[at.WANDER_L], dt, xi[1], p)
    level_m, friction_l = max(0.0, 1.0 + wander_m), max(0.0, 1.0 + wander_l) * p[at.F_CL]  # friction never pushes
    hold_l = math.inf if locked else friction_l
    here, filtered = beginning(slow, state), state[at.FILTERED]
    outside, lag = (tau, tau_ext, state[at.CLOCK]), state[at.TAU_M] - tau
    phi = here.y[2] - here.y[0] * p[at.PER_N] + here.error.value
    m, spring = on_its_piece(here, slow, outside, piece(here.y, phi, 0.0, slow, state, p), state, p)
    net = balance(here.y, m, state[at.TAU_M], tau_ext, p)
    left, rate, events, status = dt, state[at.RATE], 0, at.FINE
    while True:
        y = here.y
        hold_m = breakaway(y[0], m.elastic, level_m, here.slow, p)
        grip = (way(y[1], net[0], hold_m), way(y[3], net[1], hold_l), level_m, friction_l)
        k1 = accelerated(y, here.slow, m, outside, grip, p)
        a_m = k1.a_m + (lag * p[at.PER_J_M] if grip[0] != 0.0 else 0.0)
        if left <= 0.0:
            break
        h = left
        if grip[0] != 0.0 or grip[1] != 0.0 or p[at.SHAKE] != 0.0:
            most_a = max(abs(a_m), abs(k1.a_m))  # before and behind the drive's lag
            most = longest_substep(y[1], most_a, grip, m.phi, here.slow, spring, p)
            if not most >= at.H_LEAST:
                status = at.TOO_FAST
                break
            if most < left:
                h = left / math.ceil(left / most - 1e-9)
        after = attempt(here, k1, h, outside, lag, grip, hold_l, spring, p)
        if after.event:
            h, events = locate(here, k1, h, outside, lag, grip, hold_l, spring, p), events + 1
            after = attempt(here, k1, h, outside, lag, grip, hold_l, spring, p)
        end, keep = after.end, after.keep
        outside = (tau, tau_ext, outside[2] + h)
        status = judged(end, after.net, h, events, p)
        if status != at.FINE:
            break
        follow(after.mesh.phi - m.phi, end.y[0] - y[0], end.slow, spring, state, p)
        m, net_end = after.mesh, after.net
        if after.event:
            end = Point(halted(end.y, grip), end.slow, end.error)
            m, spring = on_its_piece(end, end.slow, outside, spring, state, p)
            net_end = balance(end.y, m, tau + lag * keep, tau_ext, p)
        travel_l = end.y[2] - y[2]
        book(state, after.energies, tau_ext * travel_l, grip[1] * friction_l * travel_l)
        filtered = low_passed(filtered, net[2], net_end[2], h, p)
        if h > at.H_SLOPE:
            rate = (net_end[2] - net[2]) / h
        lag *= keep
        left = 0.0 if h == left else left - h
        here, net = end, net_end
    shaft = (tau + lag, net[2], rate, filtered)
    if status == at.FINE:
        put_down(here, shaft, (wander_m, wander_l), outside[2], state)
    return status, (y[0], y[1], a_m), (y[2], y[3], k1.a_l), shaft
