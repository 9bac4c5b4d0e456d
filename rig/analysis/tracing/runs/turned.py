"""How far the motor of a run went: a kinematic error takes a whole turn, of one run at least.

One that swings by less shows how friction builds up and what an inertia takes; its kinematic error is that of the
others.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.strokes import strokes
from rig.core.units import TURN

WHOLE: Final = 1.0  # turns of the motor in a run with a free output: less shows no order, and no floor
SWING: Final = 0.05  # turns: less may be an encoder that stands still in its noise
STROKES: Final = 4  # two periods, which the floor is read from where nothing is repeated


def too_short(run: Recording) -> str:
    """Why a run whose motor made no turn and does not swing is none for a trace; "" for others."""
    if _turns(run) >= WHOLE or run.locked or run.procedure == "standstill" or _swings(run):
        return ""
    return _said(run)


def swings_alone(runs: Sequence[Recording]) -> dict[str, str]:
    """The runs that swing by less than a turn, by name, and why they are none for a trace, where no run turns."""
    free = [run for run in runs if not run.locked and run.procedure != "standstill"]
    return {} if any(_turns(run) >= WHOLE for run in free) else {run.name: _said(run) for run in free}


def _said(run: Recording) -> str:
    return f"its motor went {_turns(run):.2f} of a turn, a kinematic error needs a whole one"


def _turns(run: Recording) -> float:
    """Of the motor, from the farthest back to the farthest forth."""
    return float(np.ptp(np.concatenate([p.theta_m for p in run.pieces]))) / TURN


def _swings(run: Recording) -> bool:
    return _turns(run) > SWING and sum(len(strokes(p.theta_m)) for p in run.pieces) >= STROKES
