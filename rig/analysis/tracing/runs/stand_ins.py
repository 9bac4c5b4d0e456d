"""Stand-ins for readings that are not there, so that columns have something to lean on."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rig.analysis.motion.source import Source
from rig.analysis.tracing.runs.declared import believed, is_locked
from rig.analysis.tracing.runs.smoothing import flat_rate
from rig.model.effect import Array, Signals


def substituted(c: Mapping[str, Array], dt: float, run: Source, tau_ext: float) -> dict[str, Array]:
    """Stand-ins for readings that are not there, so that columns have something to lean on.

    The shaft torque of a free load is what its declared inertia and weight take; one angle is the other's times N, and
    a locked output rests.
    """
    out = dict(c)
    if not np.isfinite(out["theta_m"]).any():
        out["theta_m"] = out["theta_l"] * run.ratio
    if not np.isfinite(out["theta_l"]).any():
        out["theta_l"] = np.zeros_like(out["theta_m"]) if is_locked(run) else out["theta_m"] / run.ratio
    if not np.isfinite(out["tau_l"]).any() and not is_locked(run):
        out["tau_l"] = believed(run).J_l * flat_rate(out["theta_l"], dt, 2) - tau_ext
    return out


def in_stand_ins(added: Mapping[str, Array], piece: Signals, dt: float) -> dict[str, Array]:
    """What the noise of readings does to those `substituted` made of them: the torque of a load's inertia has its
    encoder's noise twice differentiated."""
    out: dict[str, Array] = {}
    if "theta_m" not in added and "theta_l" in added:
        out["theta_m"] = added["theta_l"] * piece.ratio
    if "theta_l" not in added and "theta_m" in added and np.any(piece.theta_l):
        out["theta_l"] = added["theta_m"] / piece.ratio
    if "tau_l" not in added and "theta_l" in {*added, *out}:
        out["tau_l"] = piece.gear.J_l * flat_rate({**added, **out}["theta_l"], dt, 2)
    return out
