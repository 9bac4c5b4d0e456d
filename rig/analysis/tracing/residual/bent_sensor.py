"""Whether a spring that is not linear is a torque sensor that is not: the weights that were declared know of it then.

What the sensor reads too little of a torque seems to wind the gear up too far, and is missing as much in the balance of
the load; a gear that is soft about zero leaves the load what it carries. Every run has a zero of its own for the
torque, so that no error shows which it is.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import of_effects, offset
from rig.analysis.tracing.residual.drifting_zeros import free
from rig.model.effect import MEASURED, Array

SPRINGS: Final = frozenset({"nonlinear_stiffness", "lost_motion"})
WEIGHTS: Final = 4  # different ones: a curve beside a straight line
APART: Final = 0.5  # N·m, of two weights
PLAINLY: Final = 3.0  # times what zeros of repeats differ by, RMS: a sensor's own zero shifts both balances as well
SAME: Final = 0.25  # of the squares of the wind-up's zeros: so little is left beside what the balance says
READ: Final = MEASURED - {"tau_m"}


def is_the_sensors(s: Solution, names: Collection[str], runs: Sequence[int]) -> bool:
    """Whether the balance of the load shows in `runs` what a spring among `names` would explain. False where too few
    weights hung on them, or some channel was not read."""
    eq = s.design.eq
    mine = [i for i in free(eq, runs) if eq.runs[i].has >= READ and (i, "L") in eq.rows and eq.runs[i].load_stated]
    if SPRINGS.isdisjoint(names) or not mine:
        return False
    hung = np.array([np.mean(np.concatenate([piece.tau_ext for piece in eq.runs[i].pieces])) for i in mine])
    if np.unique(np.round(hung / APART)).size < WEIGHTS:
        return False
    read = np.array([eq.runs[i].mean_torque for i in mine])
    angle, torque = (_bent(np.array([_zero(s, i, c) for i in mine]), read) for c in "AL")
    if float(np.sqrt(np.mean(angle**2))) < PLAINLY * eq.noise.local["A"]:
        return False
    left = angle + s.value("compliance") * torque
    return bool(left @ left < SAME * (angle @ angle))


def _zero(s: Solution, run: int, channel: str) -> float:
    """What the baseline leaves in the mean of a channel, less what all effects make of it that bend no spring: a wave
    of the output's angle has a mean in a run that goes round but in part."""
    return offset(s, run, channel) - of_effects(s, run, channel, SPRINGS)


def _bent(x: Array, torque: Array) -> Array:
    """What is left of zeros `x` (k,) beside a constant and what is in proportion to the `torque` (k,): that is a scale,
    or a stiffness."""
    z = np.stack([np.ones(torque.size), torque], 1)
    return np.asarray(x - z @ np.linalg.lstsq(z, x, rcond=None)[0])
