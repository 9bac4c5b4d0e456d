"""Repeats of one condition that differ far more than those of all others: what makes them differ is no noise.

Friction that hunts, a mode that is met: the floor that such a pair tells stands for its own condition, and not for any
other one's. Noise grows with the speed (a clock that jitters) and with the torque (a gain that wanders), by no more
than in proportion.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.special import fdtri

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.floor.repeats import Scatter
from rig.analysis.tracing.thresholds import CHANCE
from rig.model.effect import Array

OTHERS: Final = 2  # pairs of the same procedure
FAR: Final = 2.0  # times what any of them comes to at that speed and torque, at least
TORQUE: Final = 1.0  # N·m of mean torque, below which a run counts as without load


def outlying(eq: Equations, found: Sequence[Scatter]) -> list[Scatter]:
    """Pairs of freely turning runs that differ more than chance and growth with speed and torque can have it, beside
    all others of their procedure."""
    free = [s for s in found if s.pair[0] != s.pair[1] and not eq.runs[s.pair[0]].locked]
    return [s for s in free if _is_far(eq, s, [o for o in free if o is not s and _alike(eq, s, o)])]


def _alike(eq: Equations, a: Scatter, b: Scatter) -> bool:
    return eq.runs[a.pair[0]].procedure == eq.runs[b.pair[0]].procedure


def _is_far(eq: Equations, one: Scatter, others: Sequence[Scatter]) -> bool:
    if len(others) < OTHERS:
        return False
    here = _conditions(eq, one)
    expected = max(o.rms * max(1.0, float(np.max(here / _conditions(eq, o)))) for o in others)
    chance = float(np.sqrt(fdtri(one.freedom, min(o.freedom for o in others), CHANCE)))
    return bool(one.rms > max(FAR, chance) * expected)


def _conditions(eq: Equations, pair: Scatter) -> Array:
    """Mean speed [rad/s] and mean torque [N·m] of a pair, (2,); a little torque is none."""
    run = eq.runs[pair.pair[0]]
    return np.array([max(run.turning, 1e-9), max(abs(run.mean_torque), TORQUE)])
