"""One substep: equations 6-7 with friction, by the classical fourth-order Runge-Kutta method."""

from __future__ import annotations

import math

from numba import njit

from sim.kernel import layout as at
from sim.kernel.friction import sliding
from sim.kernel.gear import kinematic_error, mesh
from sim.kernel.layout import Energies, Four, Mesh, Pair, Point, Rates, Slow, Spring, Three, Vector


@njit
def rates(point: Point, outside: Three, grip: Four, spring: Spring, p: Vector) -> Rates:
    """Accelerations, powers lost, rates of what creeps behind      [ghorbel2001, Eqs. 6-7]

    `outside`: motor torque asked, torque on the load, time. `grip`: which way each side slides (0: it is held),
    relative friction of the motor, friction torque of the load.
    """
    m = mesh(point.y, point.slow, point.error, outside, spring, p)
    return accelerated(point.y, point.slow, m, outside, grip, p)


@njit
def accelerated(y: Four, slow: Slow | None, m: Mesh, outside: Three, grip: Four, p: Vector) -> Rates:
    """What the torques of the gear do to the two inertias."""
    side_m, side_l, level_m, friction_l = grip
    _, omega_m, _, omega_l = y
    friction_m = side_m * sliding(y[0], omega_m, m.elastic, level_m, slow, p)
    drive_m, drive_l = outside[0] + m.on_motor + m.aside_m, outside[1] + m.on_load + m.aside_l
    return Rates(
        a_m=p[at.PER_J_M] * (drive_m - p[at.B_M] * omega_m - friction_m) if side_m != 0.0 else 0.0,
        a_l=p[at.PER_J_L] * (drive_l - p[at.B_L] * omega_l - side_l * friction_l) if side_l != 0.0 else 0.0,
        lost_m=p[at.B_M] * omega_m**2,
        lost_l=p[at.B_L] * omega_l**2,
        lost_ml=m.lost_ml,
        lost_sp=m.lost_sp,
        friction=friction_m * omega_m,
        load=m.load,
        creep_1=m.creep_1,
        creep_2=m.creep_2,
        lost_creep=m.lost_creep,
        schedule=m.schedule,
        ripple=m.ripple,
        shake=m.shake,
    )


@njit
def followed(slow: Slow | None, k: Rates, h: float) -> Slow | None:
    """The slow states `h` s later at the rates `k`."""
    if slow is None:
        return slow  # its type, which numba takes from here, is then that of the argument
    return Slow(slow.load + h * k.load, slow.creep_1 + h * k.creep_1, slow.creep_2 + h * k.creep_2)


@njit
def point_at(y: Four, slow: Slow | None, p: Vector) -> Point:
    """The rig at these angles and speeds."""
    return Point(y, slow, kinematic_error(y[0], slow, p))


@njit
def stage(point: Point, speeds: Pair, k: Rates, h: float, kick: Pair, p: Vector) -> Point:
    """The rig `h` s beyond `point` at the rates `k` and the slow `speeds`; `kick`: what the drive's lag adds."""
    theta_m, w, theta_l, u = point.y
    y = (theta_m + h * speeds[0] + kick[1], w + h * k.a_m + kick[0], theta_l + h * speeds[1], u + h * k.a_l)
    return point_at(y, followed(point.slow, k, h), p)


@njit
def step(
    start: Point, k1: Rates, h: float, outside: Three, lag: float, grip: Four, spring: Spring, p: Vector
) -> tuple[Four, Slow | None, Energies, float]:
    """One step; each side keeps sliding, or held, as it is, and the spring stays on its piece.

    The drive's torque τ + lag·e^{−t/T} changes too fast for it. What `lag` does to a free motor is therefore integrated
    exactly, v = lag·T/J_m·(1 − e^{−t/T}) in speed and x = ∫v in angle, and the method sees the slow rest, w = ω_m − v.
    `k1` is `rates` at `start` without the lag. Gives the new angles and speeds, the slow states, the energies, and what
    share of the lag is left.
    """
    theta_m, w, theta_l, u = start.y
    half = math.exp(-0.5 * h / p[at.T_DRIVE])
    kick = lag * p[at.T_DRIVE] * p[at.PER_J_M] if grip[0] != 0.0 else 0.0
    v2, v4 = kick * (1.0 - half), kick * (1.0 - half * half)
    x2, x4 = kick * 0.5 * h - v2 * p[at.T_DRIVE], kick * h - v4 * p[at.T_DRIVE]
    middle, after = (outside[0], outside[1], outside[2] + 0.5 * h), (outside[0], outside[1], outside[2] + h)
    w2, u2 = w + 0.5 * h * k1.a_m, u + 0.5 * h * k1.a_l
    k2 = rates(stage(start, (w, u), k1, 0.5 * h, (v2, x2), p), middle, grip, spring, p)
    w3, u3 = w + 0.5 * h * k2.a_m, u + 0.5 * h * k2.a_l
    k3 = rates(stage(start, (w2, u2), k2, 0.5 * h, (v2, x2), p), middle, grip, spring, p)
    w4, u4 = w + h * k3.a_m, u + h * k3.a_l
    k4 = rates(stage(start, (w3, u3), k3, h, (v4, x4), p), after, grip, spring, p)
    s = h / 6.0
    travel = s * (w + 2.0 * (w2 + w3) + w4) + x4
    gain = s * (k1.a_m + 2.0 * (k2.a_m + k3.a_m) + k4.a_m)
    end = (
        theta_m + travel,
        w + gain + v4,
        theta_l + s * (u + 2.0 * (u2 + u3) + u4),
        u + s * (k1.a_l + 2.0 * (k2.a_l + k3.a_l) + k4.a_l),
    )
    work = outside[0] * travel + 0.5 * v4 * v4 / p[at.PER_J_M]
    if kick != 0.0:  # ∫ lag·e^{−t/T}·w dt with w a parabola
        x, keep = h / p[at.T_DRIVE], half * half
        first = (1.0 - keep * (1.0 + x)) / x
        second = (2.0 - keep * (2.0 + x * (2.0 + x))) / (x * x)
        work += kick / p[at.PER_J_M] * (w * (1.0 - keep) + h * k1.a_m * first + (gain - h * k1.a_m) * second)
    energies = Energies(
        work=work + s * (k1.ripple + 2.0 * (k2.ripple + k3.ripple) + k4.ripple),
        lost_m=s * (k1.lost_m + 2.0 * (k2.lost_m + k3.lost_m) + k4.lost_m),
        lost_l=s * (k1.lost_l + 2.0 * (k2.lost_l + k3.lost_l) + k4.lost_l),
        lost_ml=s * (k1.lost_ml + 2.0 * (k2.lost_ml + k3.lost_ml) + k4.lost_ml),
        lost_sp=s * (k1.lost_sp + 2.0 * (k2.lost_sp + k3.lost_sp) + k4.lost_sp),
        friction=s * (k1.friction + 2.0 * (k2.friction + k3.friction) + k4.friction),
        lost_creep=s * (k1.lost_creep + 2.0 * (k2.lost_creep + k3.lost_creep) + k4.lost_creep),
        schedule=s * (k1.schedule + 2.0 * (k2.schedule + k3.schedule) + k4.schedule),
        shake=s * (k1.shake + 2.0 * (k2.shake + k3.shake) + k4.shake),
    )
    slow = followed(followed(followed(followed(start.slow, k1, s), k2, 2.0 * s), k3, 2.0 * s), k4, s)
    return end, slow, energies, half * half
