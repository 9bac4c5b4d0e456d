"""Whether the encoders keep their zeros from run to run: then what shifts them from one speed to another is an effect.

A reading that comes late shifts a run that turns evenly by as much as it turns meanwhile, and shows nowhere else. Where
every run has a zero of its own that is all there is of it; but zeros that lie on one line over the speed are none.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import offset, zero
from rig.analysis.tracing.runs.recording import mean_speed
from rig.model.effect import MEASURED

RUNS: Final = 5  # that turn freely
CLEAR: Final = 12.0  # standard deviations of the slope: delays have 20 and more
# of what a torque sensor's zeros shift them by: one that was tared anew halfway makes a line of a twelfth of it
SHOWS: Final = 0.5
LEFT: Final = 0.35  # of their scatter, beside the line: what goes with the way alone leaves half


def about_a_line(s: Solution) -> float | None:
    """Scatter [rad] of the zeros of fitted runs about a line over the speed of the output, what the zero of the torque
    sensor shifts them by taken off; None where they lie on none, where runs are too few, or where the torque, which
    winds the gear up with the speed, was not measured."""
    eq = s.design.eq
    runs = [i for i in sorted({i for i, c in s.keys if c == "A"}) if not eq.runs[i].locked]
    if len(runs) < RUNS or any(not eq.runs[i].has >= MEASURED for i in runs):
        return None
    speed = np.array([mean_speed(eq.runs[i]) for i in runs]) / eq.runs[0].ratio
    taken_off = s.value("compliance") * np.array([torque_zero(s, i) for i in runs])
    zeros = np.array([zero(s, i, "A") for i in runs]) + taken_off
    z = np.stack([np.ones(speed.size), speed], 1)
    gram = z.T @ z
    if np.linalg.cond(gram) > 1e12:
        return None
    x = np.linalg.solve(gram, z.T @ zeros)
    left = zeros - z @ x
    deviation = float(np.sqrt(left @ left / (len(runs) - 2) * np.linalg.inv(gram)[1, 1]))
    on_it = abs(x[1]) > CLEAR * deviation and np.std(left) < LEFT * np.std(zeros)
    on_it = on_it and np.std(z @ x) > SHOWS * np.std(taken_off)
    return float(np.std(left)) if on_it else None


def torque_zero(s: Solution, run: int) -> float:
    """Of the torque sensor in that run, against the others', N·m; 0 where the load's balance does not tell."""
    return offset(s, run, "L") if (run, "L") in s.design.eq.rows else 0.0
