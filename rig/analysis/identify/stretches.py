"""Stretches whose mean torque is one observation of friction: plateaus, joined where one torque was given throughout.

Under constant torque friction that wanders shows in the speed. Cutting such a run wherever its speed leaves a band, and
calling each piece a point of torque against speed, takes the pieces for what made them: all lie at one torque, those
with less friction at a higher speed, and the line through them is flat.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.identify.recording import Plateau
from rig.core.units import TURN

SAME = 1e-3  # N·m between torques asked for that are the same: half a step of a drive that takes per mille of 2 N·m


def stretches(level: Sequence[Plateau]) -> list[Plateau]:
    """Plateaus in time order, those of one run under one torque joined from the first's begin to the last's end."""
    joined: list[Plateau] = []
    for plateau in level:
        if joined and _together(joined[-1], plateau):
            joined[-1] = _over(joined[-1], plateau)
        else:
            joined.append(plateau)
    return joined


def _together(a: Plateau, b: Plateau) -> bool:
    """Whether nothing but the gear changed the speed from `a` to `b`."""
    asked = _asked(a, b)
    if asked is None or a.run is not b.run or a.way != b.way or bool(a.run.followed[a.lo : b.hi].any()):
        return False
    return bool(np.isfinite(asked).all()) and float(np.ptp(asked)) <= SAME


def _asked(a: Plateau, b: Plateau) -> Array | None:
    """Torque asked for from `a` to `b`, N·m; None where the run does not say."""
    column = a.run.motion.pick(a.run.source.column("tau_ask"))
    return None if column is None else column[a.lo : b.hi]


def _over(a: Plateau, b: Plateau) -> Plateau:
    """Both and what lies between, whole turns."""
    t, theta = a.run.t, a.run.theta_m[a.lo : b.hi + 1]
    progress = np.maximum.accumulate(a.way * (theta - theta[0]))
    turns = int(progress[-1] / TURN + 0.01)  # both ends are at whole turns of their own, to a row
    hi = min(a.lo + int(np.searchsorted(progress, turns * TURN)), b.hi)
    return Plateau(a.run, a.lo, hi, float(theta[hi - a.lo] - theta[0]) / float(t[hi] - t[a.lo]))
