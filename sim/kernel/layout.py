"""Where each number stands in the kernel's two vectors, and the small records its functions hand to one another.

PER_ is one over a number, a product being quicker than a quotient. `*_AT` points to a table behind the last place.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]
Pair = tuple[float, float]  # (motor, load)
Three = tuple[float, float, float]
Four = tuple[float, float, float, float]  # θ_m, ω_m, θ_l, ω_l; or sides and friction

# The parameter vector: the paper's model with friction, then what its model lacks.
PER_N, PER_J_M, PER_J_L, K, B_M, B_L, B_ML, B_SP, SIGMA, TAU_C, TAU_S, PER_OMEGA_S, F_CL = range(13)
T_DRIVE, T_SENSOR, WANDER, T_WANDER, MODE_RATE, TERMS, TOP_ORDER, REFINE = range(13, 21)
GAP, BREAK_1, BREAK_2, TORQUE_1, TORQUE_2, K_2, K_3, CUBIC = range(21, 29)  # the spring law: φ rad, N·m, N·m/rad
KAPPA, KAPPA_ORDER, KAPPA_PHASE = range(29, 32)  # stiffness by angle
CREEP_K_1, CREEP_PER_T_1, CREEP_K_2, CREEP_PER_T_2 = range(32, 36)
A_INF, A_0, PER_T_C, PER_T_LOAD = range(36, 40)  # kinematic error by load
MU, UNEVEN, UNEVEN_ORDER, UNEVEN_PHASE, DRAG_2, DRAG_23 = range(40, 46)  # friction by load, by angle; drag by speed
BETA, WARMING, PER_T_WARM, COLD_TAU_C, COLD_TAU_S, COLD_B_M, COLD_B_ML = range(46, 53)  # friction by temperature
COGGING, COGGING_ORDER, COGGING_PHASE, RIPPLE, RIPPLE_ORDER, RIPPLE_PHASE = range(53, 59)
UNBALANCE, UNBALANCE_PHASE, SHAKE, SHAKE_RATE, SHAKE_PHASE = range(59, 64)
LINES, LINES_AT, SLIPS, SLIPS_AT, BRISTLES, BRISTLES_AT, SERIES_AT = range(64, 71)
PARAMETERS = 71  # then SERIES: (a_n, b_n, n·a_n, n·b_n); LINES: (order, a, b); SLIPS, BRISTLES: (k_i, s_i)

# The state vector. Wander is relative. From IN_MOTOR on the energy ledger [J], then the states of what the model lacks.
THETA_M, OMEGA_M, THETA_L, OMEGA_L, TAU_M, TAU_L, FILTERED, WANDER_M, WANDER_L, VALUE, SLOPE, RATE = range(12)
IN_MOTOR, IN_EXTERNAL, LOST_B_M, LOST_B_L, LOST_B_ML, LOST_B_SP, LOST_MOTOR, LOST_LOAD = range(12, 20)
LOST_HYSTERESIS, LOST_CREEP, IN_SCHEDULE = range(20, 23)
PER_LOAD, LOAD_SEEN, CREEP_1, CREEP_2, WARMTH, CLOCK, STATE_SIZE = range(23, 30)  # then x_i of SLIPS, of BRISTLES [rad]

FINE, NOT_FINITE, TOO_FAST, CHATTER = range(4)  # what `advance` reports

C_MODE = 0.16  # rad of the torsional mode per substep
C_ORDER = 0.32  # rad of the highest order of the kinematic error per substep
C_STRIBECK = 0.1  # of the time in which falling friction makes the speed grow e-fold
H_LEAST = 1e-7  # s; a state that needs less has run away: 15 orders at 10^5 rad/s
MOST_EVENTS = 10_000  # in one call; stick and slip cannot alternate that often
H_SLOPE = 1e-9  # s; across less, the slope of the shaft torque would be rounding: the last one stays
STEEPEST = math.sqrt(0.5)  # ω/ω_s where the Stribeck curve falls most
HALVINGS = 45  # of a substep, to find an event in it to the last digits


class Error(NamedTuple):
    """The pure kinematic error at one motor angle."""

    value: float  # rad
    slope: float  # dθ̃_p/dθ_m
    per_load: float  # dθ̃_p/dT̄ [rad/(N·m)]


class Slow(NamedTuple):
    """States that creep along behind the motion. None in its place: the paper's model, nothing else is compiled."""

    load: float  # T̄ [N·m], the low-passed size of the spring's torque
    creep_1: float  # rad, how far the dashpot of a creep element has followed φ
    creep_2: float


class Elements(NamedTuple):
    """Torque offset + slope·x of elements in parallel while x stays in [low, high] and does not turn against `slip`."""

    offset: float  # N·m
    slope: float  # N·m/rad
    low: float  # rad
    high: float
    slip: float  # which way some of them slip, 0: none does
    slipping: float  # N·m, torque of those that do


class Spring(NamedTuple):
    """The same of the gear's spring in φ, and of the bristles between motor and housing in θ_m.

    The cube and the stiffness by angle go by φ − shift (`live` 0: inside the dead zone, where nothing bends).
    """

    twist: Elements  # the law's piece and the hysteresis
    live: float
    shift: float  # rad
    bristles: Elements


class Mesh(NamedTuple):
    """Torques [N·m] and powers [W] of the gear, and what else acts on either side."""

    on_motor: float
    on_load: float
    aside_m: float  # bristles, cogging, ripple, stiffness by angle
    aside_l: float  # unbalance, vibration
    lost_ml: float
    lost_sp: float
    phi: float
    phi_rate: float
    elastic: float  # torque of the spring without its damper
    load: float  # rates of `Slow`
    creep_1: float
    creep_2: float
    lost_creep: float
    schedule: float  # done on the spring while the load changes the kinematic error
    ripple: float  # done by the motor's ripple
    shake: float  # done by the vibration


class Rates(NamedTuple):
    """Accelerations, then powers [W], then the rates of `Slow` and the powers of what the paper's model lacks."""

    a_m: float
    a_l: float
    lost_m: float
    lost_l: float
    lost_ml: float
    lost_sp: float
    friction: float
    load: float
    creep_1: float
    creep_2: float
    lost_creep: float
    schedule: float
    ripple: float
    shake: float


class Energies(NamedTuple):
    """What went where in one substep [J]."""

    work: float
    lost_m: float
    lost_l: float
    lost_ml: float
    lost_sp: float
    friction: float
    lost_creep: float
    schedule: float
    shake: float


class Point(NamedTuple):
    """Where the rig is, and what follows from it alone."""

    y: Four
    slow: Slow | None
    error: Error


class Attempt(NamedTuple):
    """A substep, the state after it, and whether an event lies inside it."""

    event: bool
    end: Point
    net: Three  # on motor, on load, τ_l [N·m]
    mesh: Mesh
    keep: float  # what share of the drive's lag is left
    energies: Energies
