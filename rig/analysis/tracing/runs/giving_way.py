"""Whether what holds a locked output gives way, and its angle follows the torque: a housing that moves reads like that.

The wind-up of a lock test is a thousand times as large, and takes what is read beside it for compliance of the spring.
The load angle itself has nothing else in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.recording import Recording

RUNS: Final = 2  # lock tests
LOCK: Final = 1e-7  # rad/(N·m): housings give ten times as much; what gives less is as likely the lock itself
ALIKE: Final = 0.25  # relative, of one compliance from that of all: play gives way to any torque alike
LEFT: Final = 0.5  # of what goes with the torque, RMS, beside it in all tests, counts of the encoder included


def gives_way(runs: Sequence[Recording]) -> bool:
    """Whether in every lock test the load angle goes with the torque, by as much for each N·m, and more than a lock
    gives way."""
    tests = [_of_a_test(run) for run in runs if run.locked and not run.input_locked and run.has >= {"theta_l", "tau_l"}]
    if len(tests) < RUNS:
        return False
    compliance, with_torque, beside = np.array(tests).T
    usual = float(np.median(compliance))
    alike = usual > LOCK and bool(np.all(np.abs(compliance - usual) < ALIKE * usual))
    return alike and float(np.sum(beside)) < LEFT**2 * float(np.sum(with_torque))


def _of_a_test(run: Recording) -> tuple[float, float, float]:
    """Compliance [rad/(N·m)], and sums of squares [rad²] of what goes with the torque and of what does not; a drift is
    neither."""
    angle = [run.smoother(piece.theta_l) for piece in run.pieces]
    torque = [run.smoother(piece.tau_l) for piece in run.pieces]
    time = [piece.t[run.smoother.centres(piece.t.size)] for piece in run.pieces]
    y, x, t = (np.concatenate([part - part.mean() for part in parts]) for parts in (angle, torque, time))
    z = np.stack([x, t], 1)
    if not (np.isfinite(z).all() and np.isfinite(y).all()) or np.linalg.matrix_rank(z) < 2:
        return 0.0, 0.0, 0.0
    c = np.linalg.lstsq(z, y, rcond=None)[0]
    return float(c[0]), float(np.sum((c[0] * x) ** 2)), float(np.sum((y - z @ c) ** 2))
