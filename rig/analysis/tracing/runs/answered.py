"""Orders of the motor that a side nobody reads answers by its resonance: in M they are each run's own.

Where neither the load's angle nor its torque was read T is what the load's inertia takes of a motion that is as stiff
as the motor's. Below its resonance on the gear's spring, √(K/J_l), that is so; near it the load swings several times
as far, by a damping that nothing here tells. At such speeds an order says nothing of what made it. Slow runs do. And so
it is of a motor whose angle nobody read: what its inertia takes is known by the load's motion and torque twice
differentiated, which is their noise, below √(K/J_m)/N already.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.runs.declared import UNKNOWN
from rig.analysis.tracing.runs.recording import Recording
from rig.core.units import TURN
from rig.model.effect import Array, Signals
from rig.model.fourier import PAPER_ORDERS
from rig.model.waves import powers

NEAR: Final = 0.2  # of the resonance: a load swings 4 % further than a stiff one there
EVEN: Final = 1.3  # of the speed of its slowest quarter, that of its fastest: waves of one size all along
SECTORS: Final = 12  # of a turn, in all of which a run has to be slow at some time
KEPT: Final = 4  # order that is told in the rows that a run of uneven speed keeps


def slow_enough(run: Recording) -> float:
    """Rad/s of an order, below which the unread side is as stiff as the other; infinite where both were read."""
    if run.locked or not {"tau_m", "t"} <= run.has or {"theta_m", "theta_l"} <= run.has:
        return np.inf
    # as declared: what a fit makes of an inertia leans on which orders it is asked
    K, J_m, J_l = (abs(run.declared.get(name, getattr(UNKNOWN, name))) for name in ("K", "J_m", "J_l"))
    if "theta_m" not in run.has:
        return float(NEAR * np.sqrt(K / J_m) / run.ratio)
    return np.inf if "tau_l" in run.has else float(NEAR * np.sqrt(K / J_l))


def lowest_answered(run: Recording) -> float:
    """The lowest order that the unread side answers at the speed of a run; infinite where there is none."""
    if not np.isfinite(limit := slow_enough(run)):
        return np.inf
    lowest = np.ceil(limit / max(run.turning, 1e-9)) if run.keeps_speed(EVEN) else KEPT + 1
    return float(lowest) if lowest <= PAPER_ORDERS else np.inf


def told(piece: Signals, run: Recording) -> Array:
    """Which rows of a piece say something of what turns the motor, (n,) of 0 and 1: of a run whose speed changes all
    along, as that of a joint which swings, the slow ones alone, and none where those are no whole turn of the motor. No
    wave of one size stands for what is answered there.
    """
    if not _swings(run):
        return np.ones(piece.t.size)
    return np.zeros(piece.t.size) if too_fast(run) else _slow(piece, run).astype(float)


def too_fast(run: Recording) -> bool:
    """Whether a run swings so fast that nothing is told of what turns its motor."""
    if not _swings(run):
        return False
    at = np.concatenate([piece.theta_m[_slow(piece, run)] for piece in run.pieces])
    return np.unique(np.floor(at % TURN / TURN * SECTORS)).size < SECTORS


def _swings(run: Recording) -> bool:
    return bool(np.isfinite(slow_enough(run))) and not run.keeps_speed(EVEN)


def _slow(piece: Signals, run: Recording) -> Array:
    return np.asarray(KEPT * np.abs(piece.omega_m) < slow_enough(run))


def answered(run: Recording) -> Array:
    """Waves of those, pieces joined, all rows of M (n, q)."""
    f, lowest = run.smoother.of("M"), lowest_answered(run)
    waves = np.concatenate([f(powers(piece.theta_m, PAPER_ORDERS)) for piece in run.pieces])
    return waves[:, np.repeat(np.arange(1, PAPER_ORDERS + 1) >= lowest, 2)]
