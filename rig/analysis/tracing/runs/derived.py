"""Speeds, accelerations and the smooth torque of a piece, from its readings."""

from __future__ import annotations

from collections.abc import Mapping

from rig.analysis.tracing.runs.smoothing import Smoother, flat, flat_rate
from rig.model.effect import Array


def derived(c: Mapping[str, Array], smooth: Smoother) -> dict[str, Array]:
    """Of readings at the working rate, (n,) each, by the name it has in `Signals`."""
    dt = smooth.dt
    return {
        "omega_m": flat_rate(c["theta_m"], dt, 1),
        "alpha_m": flat_rate(c["theta_m"], dt, 2),
        "omega_l": flat_rate(c["theta_l"], dt, 1),
        "alpha_l": flat_rate(c["theta_l"], dt, 2),
        "torque": flat(c["tau_l"]),
        "torque_rate": flat_rate(c["tau_l"], dt, 1),
    }
