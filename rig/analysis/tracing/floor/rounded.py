"""What the rounding of the encoders leaves in each channel: no floor is believed that is less.

Neighbouring turns of a motor whose counts, and those of the load for one of its turns, are whole numbers are rounded
alike, so that what they differ by knows nothing of it: in the load's balance it is J_l times what rounding makes of an
acceleration, and with an encoder of 324 000 counts twice what the torque sensor's noise is.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.runs.recording import Recording

UNIFORM: Final = 1 / 12**0.5  # RMS of what rounds to one count
AT_LEAST: Final = 0.25  # what the low-pass leaves of that in an angle at least
FAST: Final = 1.0  # count a row: of a slower encoder rounding comes in steps, and is no white noise


def rounded(eq: Equations, channel: str) -> float:
    """RMS that rounding leaves in that channel, the least of all runs that have it: rad in A, N·m in M and L; 0 where
    none is known."""
    runs = [eq.runs[i] for i, c in eq.rows if c == channel]
    found = [_in_an_angle(run) if channel == "A" else _in_a_torque(run, channel) for run in runs]
    return min((rms for rms in found if rms > 0 or channel == "A"), default=0.0)


def _in_an_angle(run: Recording) -> float:
    return AT_LEAST * UNIFORM * float(np.hypot(run.step_m / run.ratio, run.step_l))


def _in_a_torque(run: Recording, channel: str) -> float:
    """The inertia on that side times the acceleration that rounding makes; 0 of an encoder that hardly turns."""
    load = channel == "L"
    step, speed = (run.step_l, run.turning / run.ratio) if load else (run.step_m, run.turning)
    piece = run.pieces[0]
    if run.locked or "t" not in run.has or step <= 0 or speed * piece.dt < FAST * step * piece.thinned:
        return 0.0
    inertia = piece.gear.J_l if load else piece.gear.J_m
    return float(inertia * UNIFORM * step / piece.thinned**0.5 * run.smoother.of(channel).lets_through(2))
