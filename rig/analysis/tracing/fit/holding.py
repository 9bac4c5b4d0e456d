"""Rows in which an equation of the rig holds: where it slides, where an angle is known, away from ends."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.runs.answered import told
from rig.analysis.tracing.runs.counts import FREE, LOCKED, one_a_stay, resting
from rig.analysis.tracing.runs.first_stroke import has_turned
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.sliding import settled
from rig.model.effect import Array, Signals

ENDS: Final = 8  # rows at each end of a piece, where the filters of the effects have no neighbours


SLIDING: Final = 0.25  # of the mean load speed: slower, and the load's friction has no sure sign


def holds(piece: Signals, run: Recording, channel: str) -> Array:
    """Rows in which the channel's equation holds: all but the ends in A, where it moves; sliding ones in M and L, those
    beside them in R."""
    smooth = run.smoother
    inside = np.ones(smooth.rows(piece.t.size), dtype=bool)
    inside[:ENDS] = inside[-ENDS:] = False
    sliding = smooth(settled(piece).astype(float)) > 1 - 1e-9
    if channel == "R":
        signed = smooth((piece.way != 0).astype(float)) > 1 - 1e-9
        near = inside & ~sliding & (signed | run.look.reversals)
        return np.asarray(near & _has_turned(piece, run) if run.locked else near)
    if channel == "A":
        known = inside & _angle_known(piece, run)
        torque_known = run.locked or "tau_l" in run.knows
        return np.asarray(known if torque_known else known & sliding & _load_slides(piece, run))
    if channel == "L":
        sliding &= _load_slides(piece, run)
    else:
        sliding &= smooth(told(piece, run)) > 1 - 1e-9
        if run.locked:
            sliding &= _has_turned(piece, run)
    return np.asarray(inside & sliding)


def _has_turned(piece: Signals, run: Recording) -> npt.NDArray[np.bool_]:
    """Rows from the first reversal on: friction that builds up begins where no run tells, and so does a loop."""
    return has_turned(piece, run)[run.smoother.centres(piece.t.size)]


def _load_slides(piece: Signals, run: Recording) -> npt.NDArray[np.bool_]:
    """Rows in which the load's friction has a sure sign, and with it the torque that was not measured."""
    smooth, moving = run.smoother, settled(piece)
    usual = float(np.median(np.abs(piece.omega_m[moving]))) / run.ratio if moving.any() else 0.0
    rate = smooth.same(piece.theta_l, 1) * piece.way
    return np.asarray(smooth((moving & (rate > SLIDING * usual)).astype(float)) > 1 - 1e-9)


def _angle_known(piece: Signals, run: Recording) -> npt.NDArray[np.bool_]:
    """Rows in which the motor's angle is known to better than a count; with a locked output one of every stay
    too, and none before the first reversal. Of one that is held it always is."""
    f = run.smoother
    if run.input_locked:
        return _has_turned(piece, run)
    rest = resting(piece.theta_m, piece.dt, run.counts_m, LOCKED if run.locked else FREE)
    if not run.locked:
        return np.asarray(f(rest.astype(float)) < 1e-9, dtype=np.bool_)
    stays = one_a_stay(rest[f.centres(piece.t.size)], round(4 * LOCKED / (f.dt * f.step)))
    return np.asarray(stays & _has_turned(piece, run))
