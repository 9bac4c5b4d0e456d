"""Orders of the motor that a load nobody reads answers by its resonance: in M they are each run's own.

Where neither the load's angle nor its torque was read T is what the load's inertia takes of a motion that is as stiff
as the motor's. Below its resonance on the gear's spring, √(K/J_l), that is so; near it the load swings several times
as far, by a damping that nothing here tells. At such speeds an order says nothing of what made it. Slow runs do.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array
from rig.model.waves import powers

NEAR: Final = 0.2  # of the resonance: a load swings a twentieth further than a stiff one there


def lowest_answered(run: Recording) -> float:
    """The lowest order that its load answers at the speed of a run; infinite where the load, or none, was read."""
    if not run.load_unread or "theta_l" in run.has or "t" not in run.has:
        return np.inf
    gear = run.pieces[0].gear
    return float(np.ceil(NEAR * np.sqrt(gear.K / gear.J_l) / max(run.turning, 1e-9)))


def answered(run: Recording, orders: int) -> Array:
    """Waves of those up to `orders`, pieces joined, all rows of M (n, q)."""
    f, lowest = run.smoother.of("M"), lowest_answered(run)
    waves = np.concatenate([f(powers(piece.theta_m, orders)) for piece in run.pieces])
    return waves[:, np.repeat(np.arange(1, orders + 1) >= lowest, 2)]
