"""Whether friction builds up over a way where the motor turns back, or jumps: what the equations leave out tells.

Around a reversal the sign of a constant friction is unknown for as long as a low-pass is wide, and the rows there stand
in no equation. Friction that builds up needs no sign: it follows the angle. Over milliradians it is done with before
the equations begin, and shows nowhere else; the torque there is then what one way explains, the same in all runs, and a
jump leaves twice as much.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array, Signals
from rig.model.memory import presliding

NEAR: Final = 0.12  # s on both sides of a reversal
# s of one in a lock test, where the motor is slow: what friction that is viscous close to rest makes in a tenth of a
# second, a way explains as well. Of 161 campaigns of four exams, by what a jump leaves, four with such friction were at
# 0.09 to 0.39 and one, over 1 mrad, at 0.77; a friction that falls with the speed at 0.60, all else from 0.70
NEAR_LOCKED: Final = 0.5
AROUND: Final = 2.0  # s: the same motion, in which friction has its sign
JUMP: Final = 1.5e-4  # rad of the motor: a count or two of an encoder, over which even a jump seems to build up
# rad; what takes longer the equations see
WAYS: Final = (6e-4, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 4e-3, 5e-3, 7e-3, 1e-2, 1.5e-2, 2.5e-2)
# of what a jump leaves, RMS. Of 591 campaigns of several plants 19 with such friction were at 0.18 to 0.50 (one more,
# over 70 mrad, the equations see); of the others an encoder's disc that rocks with the way was at 0.71, a log under an
# arm's weight at 0.32 with the longest way, which does not count, all else from 0.77
LESS: Final = 0.6
ENOUGH: Final = 8  # runs
REVERSALS: Final = 2  # in all runs, at least, but where one leaves less than
HARDLY: Final = 0.3  # of what a jump does: two true ones of exams 104 and 105 were at 0.12 and 0.15
MOST: Final = 40  # in one run: a motor that trembles turns back without going anywhere
TURN: Final = 2.0  # rad that the motor goes at least where the output is free


def builds_up(runs: Sequence[Recording]) -> tuple[bool, ...]:
    """In which runs one way over which the motor's friction builds up explains what is left at reversals: False those
    whose output turns, True those in which it is locked. One reversal alone says so only where hardly anything is left,
    or where those of the other kind say it too."""
    read = {locked: _explained([run for run in runs if run.locked is locked]) for locked in (False, True)}
    less = {locked: left for locked, (left, _) in read.items() if left < LESS}
    count = sum(read[locked][1] for locked in less)
    return tuple(locked for locked, left in less.items() if count >= REVERSALS or left < HARDLY)


def _explained(runs: Sequence[Recording]) -> tuple[float, int]:
    """What the best way leaves of what a jump does, all `runs` together: in one of them noise or a large load may hide
    it; and reversals that were read. Infinite where it is none, or the longest."""
    turning_back = (one for run in runs if (one := _at_reversals(run)) is not None)
    found = list(itertools.islice(turning_back, ENOUGH))
    count = sum(count for _, count in found)
    if not count:
        return np.inf, 0
    left = np.sqrt(np.sum([squares for squares, _ in found], axis=0))
    best = int(np.argmin(left[1:]))
    return (float(left[1 + best] / left[0]) if best < len(WAYS) - 1 else np.inf), count


def _at_reversals(run: Recording) -> tuple[Array, int] | None:
    """What a jump and each of the ways leave, squares (1 + ways,), and reversals it was read at; None of a run that
    does not turn back, or in which a torque was not measured."""
    if not {"theta_m", "tau_m", "tau_l", "t"} <= run.has:
        return None
    parts = [(piece, at) for piece in run.pieces if (at := reversals(piece)).size]
    count = sum(at.size for _, at in parts)
    if not 0 < count <= MOST or (not run.locked and max(float(np.ptp(piece.theta_m)) for piece, _ in parts) < TURN):
        return None
    return np.sum([_left(piece, at, run) for piece, at in parts], axis=0), count


def reversals(piece: Signals) -> npt.NDArray[np.int64]:
    """Rows at which the motor slid one way before and the other after, with enough on both sides, (k,)."""
    slides = np.flatnonzero(piece.way != 0)
    turned = np.flatnonzero(np.diff(piece.way[slides]) != 0)
    rows = (slides[turned] + slides[turned + 1]) // 2
    inside = (rows * piece.dt > AROUND / 2) & ((piece.t.size - rows) * piece.dt > AROUND / 2)
    return np.asarray(rows[inside])


def _left(piece: Signals, at: npt.NDArray[np.int64], run: Recording) -> Array:
    """Sums of squares [(N·m)²] near the reversals `at` of the torque of a motor whose friction jumps, or builds up over
    each of the ways, (1 + ways,), beside inertia, damping, and what goes with the angle, or with the torque of an
    output that is locked; those are fitted around them."""
    smooth, theta = run.smoother, np.ascontiguousarray(piece.theta_m)
    rows = np.arange(theta.size)
    away = np.min(np.abs(rows[:, None] - at), axis=1) * piece.dt
    around, near = away < AROUND, away < (NEAR_LOCKED if run.locked else NEAR)
    torque = np.nan_to_num(piece.torque)
    waves = [f(n * theta) for n in (1, 2) for f in (np.cos, np.sin)]
    with_it = [torque, smooth.same(np.abs(torque) * piece.way)] if run.locked else waves
    beside = np.stack([smooth.same(theta, 2), smooth.same(theta, 1), np.ones(rows.size), *with_it], 1)
    y = smooth.same(piece.tau_m) - torque / run.ratio
    start, out = float(np.sign(piece.omega_m[0])), []
    for way in (JUMP, *WAYS):
        z = np.column_stack([smooth.same(presliding(theta, way, start)), beside])
        e = y[near] - z[near] @ np.linalg.lstsq(z[around], y[around], rcond=None)[0]
        out.append(float(e @ e))
    return np.array(out)
