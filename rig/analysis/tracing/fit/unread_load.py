"""A load whose torque no sensor reads, in A and M: what effects in it are found to take, and its inertia if unstated.

The torque T there is what the load's inertia and weight take. An effect found in the load, the weight of an arm, adds
to it what it carries, G. It does so in T itself, which winds the gear up, presses on the teeth and stands before the
slope of θ̃_p, and its own columns say by how much more or less than that:

    A  θ̃ = … + T/K + (g − G)/K_0         M  τ_m = … + T·(1/N − θ̃_p′) + (g − G)·(1/N − θ̃_p′_0)

With G in T the spring shows by a weight that hardly moves. And with both a weight and a wind-up of its inertia the
motor's torque, in N·m, tells how heavy the load is.
"""

from __future__ import annotations

import numpy as np

from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array, Signals

Columns = tuple[Array, dict[str, Array]]


def beside_load(channel: str, y: Array, columns: dict[str, Array], s: Signals, run: Recording) -> Columns:
    """Response (n,) and columns of A or M of one piece, less what T has of effects that have columns of their own, and
    beside what more inertia would take."""
    f, share = run.smoother.of(channel), _share(channel, s)
    if s.carried is not None:
        y = y + f(s.carried * share)
    if run.look.inertia and (run.carries or not run.look.rigid):
        columns = columns | {"inertia": f(s.alpha_l * share)}
    return y, columns


def _share(channel: str, s: Signals) -> Array:
    """Of a torque on the load, what shows in A or M, (n,)."""
    return np.full(s.t.size, 1.0 / s.gear.K) if channel == "A" else s.lever
