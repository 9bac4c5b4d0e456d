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
AROUND: Final = 2.0  # s: the same motion, in which friction has its sign
JUMP: Final = 1.5e-4  # rad of the motor: a count or two of an encoder, over which even a jump seems to build up
# rad; what takes longer the equations see
WAYS: Final = (6e-4, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 4e-3, 5e-3, 7e-3, 1e-2, 1.5e-2, 2.5e-2)
# of what a jump leaves, RMS; of 230 campaigns without such friction none came below it, with it were 0.1 to 0.5
HALF: Final = 0.5
ENOUGH: Final = 8  # runs
SHOWN: Final = 0.6  # of them
ALIKE: Final = 2.0  # how far a run's way may be from the usual one, as a ratio
REVERSALS: Final = 2  # in all runs, at least
MOST: Final = 40  # in one run: a motor that trembles turns back without going anywhere
TURN: Final = 2.0  # rad that the motor goes at least: a locked one winds a spring up and down


def builds_up(runs: Sequence[Recording]) -> bool:
    """Whether the motor's friction builds up over one way in most of the runs that turn back: a large load hides
    it."""
    turning_back = (one for run in runs if (one := _way(run)) is not None)
    found = list(itertools.islice(turning_back, ENOUGH))
    shown = [way for way, _ in found if way > JUMP]
    if sum(count for _, count in found) < REVERSALS or len(shown) < SHOWN * len(found):
        return False
    usual = float(np.median(shown))
    return all(usual / ALIKE <= way <= usual * ALIKE for way in shown)


def _way(run: Recording) -> tuple[float, int] | None:
    """Over which way [rad] friction builds up, JUMP where it jumps, and reversals it was read at; None of a run that
    does not turn back, or in which a torque was not measured."""
    if run.locked or not {"theta_m", "tau_m", "tau_l", "t"} <= run.has:
        return None
    parts = [(piece, at) for piece in run.pieces if (at := reversals(piece)).size]
    count = sum(at.size for _, at in parts)
    if not 0 < count <= MOST or max(float(np.ptp(piece.theta_m)) for piece, _ in parts) < TURN:
        return None
    left = np.sqrt(np.sum([_left(piece, at, run) for piece, at in parts], axis=0))
    best = int(np.argmin(left[1:]))
    inside = best < len(WAYS) - 1 and left[1 + best] < HALF * left[0]
    return (WAYS[best] if inside else JUMP), count


def reversals(piece: Signals) -> npt.NDArray[np.int64]:
    """Rows at which the motor slid one way before and the other after, with enough on both sides, (k,)."""
    slides = np.flatnonzero(piece.way != 0)
    turned = np.flatnonzero(np.diff(piece.way[slides]) != 0)
    rows = (slides[turned] + slides[turned + 1]) // 2
    inside = (rows * piece.dt > AROUND / 2) & ((piece.t.size - rows) * piece.dt > AROUND / 2)
    return np.asarray(rows[inside])


def _left(piece: Signals, at: npt.NDArray[np.int64], run: Recording) -> Array:
    """Sums of squares [(N·m)²] near the reversals `at` of the torque of a motor whose friction jumps, or builds up over
    each of the ways, (1 + ways,), beside inertia, damping, and what goes with the angle; those are fitted around
    them."""
    smooth, theta = run.smoother, np.ascontiguousarray(piece.theta_m)
    rows = np.arange(theta.size)
    away = np.min(np.abs(rows[:, None] - at), axis=1) * piece.dt
    around, near = away < AROUND, away < NEAR
    waves = [f(n * theta) for n in (1, 2) for f in (np.cos, np.sin)]
    beside = np.stack([smooth.same(theta, 2), smooth.same(theta, 1), np.ones(rows.size), *waves], 1)
    y = smooth.same(piece.tau_m) - np.nan_to_num(piece.torque) / run.ratio
    start, out = float(np.sign(piece.omega_m[0])), []
    for way in (JUMP, *WAYS):
        z = np.column_stack([smooth.same(presliding(theta, way, start)), beside])
        e = y[near] - z[near] @ np.linalg.lstsq(z[around], y[around], rcond=None)[0]
        out.append(float(e @ e))
    return np.array(out)
