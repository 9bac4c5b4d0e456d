"""Has the motor's encoder kept its zero since a slow run? The kinematic error bends the line of a lock test, and only
from one zero the way the slow run says."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Source, motion_of
from rig.core.units import TURN
from rig.model.fourier import FourierSeries
from rig.model.transmission_error import transmission_error

ROWS = 500  # means that the run is told by: noise and counts are far below what the error bends then
ZEROS = 360  # tried, a degree apart
AS_WELL = 1.5  # times what the slow run's own zero leaves, RMS: another one that leaves less may be it
BY_CHANCE = 0.02  # of all zeros, how many may
LEAST = 1.2  # times what the best of them leaves, that the own one may: half a turn off, even orders are the same
NEAR = 6  # degrees: so far off the own one it bends nearly alike


def shown_by_windup(lock: Source, slow: FourierSeries) -> bool:
    """Whether a lock test shows that it counts the motor angle from the zero of the run `slow` [rad] was found from: a
    straight line, with a gap between winding up and down, is left less than it, and by hardly another zero.

    A spring that is not straight leaves more from any zero, and shows none.
    """
    told = _told(lock)
    if told is None:
        return False
    theta, windup, line = told
    left = _left(line, windup)
    own, *others = (_left(line, windup - slow.value(theta + zero)) for zero in TURN * np.arange(ZEROS) / ZEROS)
    as_well = np.mean(np.array(others[NEAR:-NEAR]) < AS_WELL * own)
    return bool(AS_WELL * own < left and own < LEAST * min(others) and as_well <= BY_CHANCE)


def _told(lock: Source) -> tuple[Array, Array, Array] | None:
    """Motor angle [rad] and wind-up [rad] of the test's means (n,), and a line in the torque with a gap, (n, 3)."""
    motion = motion_of(lock)
    if motion is None or motion.theta_l is None:
        return None
    tau = motion.pick(lock.column("tau_l"))
    if tau is None or not np.isfinite(tau).all() or not np.ptp(tau) or (size := tau.size // ROWS) < 1:
        return None
    read = (motion.theta_m, motion.theta_l, tau)
    theta, load, torque = (x[: ROWS * size].reshape(ROWS, size).mean(axis=1) for x in read)
    line = np.column_stack([np.ones(ROWS), torque, np.sign(np.gradient(torque))])
    return theta, transmission_error(theta, load, motion.ratio), line


def _left(line: Array, windup: Array) -> float:
    """What the line leaves of a wind-up, rad RMS."""
    x, *_ = np.linalg.lstsq(line, windup, rcond=None)
    return float(np.sqrt(np.mean((windup - line @ x) ** 2)))
