"""Friction of both sides from the plateaus' means: straight lines of torque against speed, one sign each way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.findings.collected import pm
from rig.analysis.findings.result import Array
from rig.analysis.identify.means import Mean, variances
from rig.analysis.identify.solve import Solved, random_effects
from rig.core.units import RPM

STRIBECK = np.geomspace(0.1, 30.0, 40)  # rad/s tried for ω_s
CLEAR = 12.0  # of χ²: a Stribeck term must explain this much to be believed, two parameters at odds of 400
SLOW = 5.0  # rad/s, 48 rpm: a fall of friction is looked for below, straight drag above
CONTRADICTS = 4.0  # standard errors by which slow plateaus must miss the line of the fast ones
BENDS = 2.0  # halves of its 95 % interval that a part with the square of the speed must have
SPEEDS = 4  # different ones, below which a line with a bend is one through every point
APART = 1.1  # times: speeds further apart are different ones


@dataclass(frozen=True)
class MotorFriction:
    """τ_f = [τ_c + fall·exp(−(ω/ω_s)²)]·sgn ω + B·ω + offset, seen at the motor beside the shaft torque, SI."""

    solved: Solved  # columns: B, τ_c, then offset where both directions were seen, then fall where it is clear
    B: int
    tau_c: int
    offset: int | None
    fall: int | None
    omega_s: float  # rad/s, NaN without a fall
    both_ways: bool
    rows: tuple[Mean, ...]
    doubt: str = ""  # what the slow plateaus say against the line, "" when nothing
    bend: str = ""  # what all of them say against its being straight, "" when nothing


@dataclass(frozen=True)
class LoadFriction:
    """F = F_cl·sgn ω + B_l·ω_l + zero of the torque sensor, SI."""

    solved: Solved
    B_l: int
    F_cl: int
    zero: int | None
    both_ways: bool
    rows: tuple[Mean, ...]


def unloaded(means: Sequence[Mean]) -> list[Mean]:
    """Those without a weight, where there are enough of them: friction may depend on the load."""
    free = [m for m in means if m.tau_ext == 0.0]
    return free if len(free) >= 4 else list(means)


def motor_friction(means: Sequence[Mean]) -> MotorFriction | None:
    """None with fewer than four plateaus or a single speed: drag and Coulomb friction are then one number.

    The straight line is fitted above SLOW where that gives one by itself and the slow plateaus contradict it.
    """
    rows = [m for m in unloaded(means) if np.isfinite(m.motor)]
    if not _speeds_differ(rows):
        return None
    v = variances([m.motor_side.pieces for m in rows], [m.duration for m in rows])
    if not np.isfinite(v).all():
        return None
    omega, y = np.array([m.omega for m in rows]), np.array([m.motor for m in rows])
    both = _both_ways(rows)
    plain, offset, doubt = _columns(omega, both), 2 if both else None, ""
    straight, fast = random_effects(plain, y, v), np.abs(omega) >= SLOW
    faster = [m for m, f in zip(rows, fast, strict=True) if f]
    # fast runs of one direction alone do not tell τ_c from an offset: there is no line of theirs to be off
    if not fast.all() and _speeds_differ(faster) and _both_ways(faster) == both:
        line = random_effects(plain[fast], y[fast], v[fast])
        excess = np.sign(omega) * (y - plain @ line.coefficients)
        slow = float(np.mean(excess[~fast]))
        u = float(np.sqrt(np.mean(v[~fast] + line.between**2) / max((~fast).sum(), 1) + line.u(1) ** 2))
        if abs(slow) > CONTRADICTS * u:
            fall, speed = _stribeck(plain, omega, y, v, line)
            if fall is not None:
                return MotorFriction(fall, 0, 1, offset, plain.shape[1], speed, both, tuple(rows))
            straight = line
            doubt = (
                f"Below {SLOW * 9.55:.0f} rpm the motor's friction is {slow:+.4f} N·m off the line of the faster runs "
                f"(1 σ {u:.4f} N·m): tau_c and the drag are those above; how it gets there takes three slow speeds."
            )
    bend = _bend(plain[fast], omega[fast], y[fast], v[fast]) if fast.any() else ""
    return MotorFriction(straight, 0, 1, offset, None, float("nan"), both, tuple(rows), doubt, bend)


def _bend(plain: Array, omega: Array, y: Array, v: Array) -> str:
    """A sentence where a part of the friction grows with the square of the speed, or falls; "" where the line does."""
    speeds = np.sort(np.abs(omega))
    if 1 + np.count_nonzero(speeds[1:] > APART * speeds[:-1]) < SPEEDS:
        return ""
    bent = random_effects(np.column_stack([plain, omega * np.abs(omega)]), y, v)
    square, half, top = float(bent.coefficients[-1]), bent.half(-1), float(speeds[-1])
    if abs(square) < BENDS * half:
        return ""
    drag, coulomb = (pm(float(bent.coefficients[i]), bent.half(i), unit) for i, unit in ((0, "N·m·s/rad"), (1, "N·m")))
    return (
        f"Friction is no straight line over the speed: a part that goes with its square is "
        f"{pm(square * top**2, half * top**2, 'N·m')} at {top / RPM:.0f} rpm, and beside it the drag is {drag} and the "
        f"Coulomb friction {coulomb}. Those of the straight line are off by more than their intervals say; hdrig trace "
        "looks for what bends it."
    )


def total_friction(means: Sequence[Mean]) -> MotorFriction | None:
    """The same of all that the rig rubs, by the drive's torque alone: what there is without a torque sensor.

    Its slope is B_m + B_ml·(1 + σ/N)² + B_l/N², its Coulomb part τ_c + F_cl/N.
    """
    return motor_friction([replace(m, motor_side=m.all_sides) for m in means])


def load_friction(means: Sequence[Mean], ratio: float) -> LoadFriction | None:
    """None with fewer than four plateaus or a single speed."""
    rows = [m for m in means if m.tau_ext == 0.0 and np.isfinite(m.load)]
    if not _speeds_differ(rows):
        return None
    v = variances([m.load_side.pieces for m in rows], [m.duration for m in rows])
    if not np.isfinite(v).all():
        return None
    omega_l, y = np.array([m.omega for m in rows]) / ratio, np.array([m.load for m in rows])
    both = _both_ways(rows)
    solved = random_effects(_columns(omega_l, both), y, v)
    return LoadFriction(solved, 0, 1, 2 if both else None, both, tuple(rows))


def _columns(omega: Array, both: bool) -> Array:
    columns = [omega, np.sign(omega)]
    return np.column_stack([*columns, np.ones(omega.size)] if both else columns)


def _both_ways(rows: Sequence[Mean]) -> bool:
    return {m.way for m in rows} == {1.0, -1.0}


def _speeds_differ(rows: Sequence[Mean]) -> bool:
    speeds = sorted(abs(m.omega) for m in rows)
    return len(rows) >= 4 and speeds[-1] > 2.0 * speeds[0]


def _stribeck(plain: Array, omega: Array, y: Array, v: Array, straight: Solved) -> tuple[Solved | None, float]:
    """The fit with a falling part, and its speed, where three slow speeds ask for it clearly."""
    slow = np.unique(np.round(np.abs(omega[np.abs(omega) < SLOW]), 1))
    if slow.size < 3:
        return None, float("nan")
    spread = v + straight.between**2
    base = float(np.sum((y - plain @ straight.coefficients) ** 2 / spread))
    best = base - CLEAR
    found: tuple[Solved | None, float] = (None, float("nan"))
    for speed in STRIBECK:
        column = np.sign(omega) * np.exp(-((omega / speed) ** 2))
        if np.max(np.abs(column)) < 1e-3:
            continue
        X = np.column_stack((plain, column))
        solved = random_effects(X, y, v)
        chi2 = float(np.sum((y - X @ solved.coefficients) ** 2 / spread))
        if chi2 < best and solved.coefficients[-1] > 0.0:
            best, found = chi2, (solved, float(speed))
    return found
