"""Coefficients that no gear has below zero: a sensor has the other sign than the rest of the campaign says."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.covariance import scatter
from rig.analysis.tracing.fit.model import Solution
from rig.core.errors import UsageError

SURELY: Final = 5.0  # standard deviations below zero
NEGATIVE: Final[Mapping[str, tuple[tuple[str, ...], str]]] = {
    "τ_m": (("tau_c",), "the friction of the motor comes out negative"),
    "τ_l": (("compliance", "J_l"), "stiffness of the gear and inertia of the load both come out negative"),
}
"""By sensor: coefficients that its sign turns over together, and what they are."""


def refuse_negative(s: Solution, name: str) -> None:
    """Raises UsageError when a sensor's sign is the other way round than the rest of the campaign `name` says."""
    spread = np.sqrt(np.maximum(np.diag(scatter(s)), 0.0))
    for sensor, (coefficients, words) in NEGATIVE.items():
        if all(s.value(c) < -SURELY * spread[INDEX[c]] and s.value(c) < 0.0 for c in coefficients):
            raise UsageError(f"{name}: {words}; {sensor} seems to have the other sign than equations 6 and 7 give it")
