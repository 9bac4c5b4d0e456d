"""Orders of the motor that a side nobody reads answers by its resonance: in M they are each run's own.

Where neither the load's angle nor its torque was read T is what the load's inertia takes of a motion that is as stiff
as the motor's. Below its resonance on the gear's spring, √(K/J_l), that is so; near it the load swings several times
as far, by a damping that nothing here tells. At such speeds an order says nothing of what made it. Slow runs do. And so
it is of a motor whose angle nobody read: what its inertia takes is known by the load's motion and torque twice
differentiated, which is their noise, below √(K/J_m)/N already.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.runs.declared import UNKNOWN
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array
from rig.model.waves import powers

HIGHEST: Final = 15  # order of θ̃_p      [ghorbel2001, Eq. 8]
NEAR: Final = 0.2  # of the resonance: a load swings a twentieth further than a stiff one there


def lowest_answered(run: Recording) -> float:
    """The lowest order that the unread side answers at the speed of a run; infinite where both were read, or it
    turns too slowly."""
    if run.locked or not {"tau_m", "t"} <= run.has or {"theta_m", "theta_l"} <= run.has:
        return np.inf
    # as declared: what a fit makes of an inertia leans on which orders it is asked
    K, J_m, J_l = (abs(run.declared.get(name, getattr(UNKNOWN, name))) for name in ("K", "J_m", "J_l"))
    if "theta_m" not in run.has:
        resonance = np.sqrt(K / J_m) / run.ratio
    elif "tau_l" not in run.has:
        resonance = np.sqrt(K / J_l)
    else:
        return np.inf
    lowest = np.ceil(NEAR * resonance / max(run.turning, 1e-9))
    return float(lowest) if lowest <= HIGHEST else np.inf


def answered(run: Recording) -> Array:
    """Waves of those, pieces joined, all rows of M (n, q)."""
    f, lowest = run.smoother.of("M"), lowest_answered(run)
    waves = np.concatenate([f(powers(piece.theta_m, HIGHEST)) for piece in run.pieces])
    return waves[:, np.repeat(np.arange(1, HIGHEST + 1) >= lowest, 2)]
