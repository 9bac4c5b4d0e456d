"""What the fit says of the gear beside what the manifests declare: another unit, or a declaration that is worth a word.

Angles in degrees make stiffness and both inertias 57.3 times too small, torques in mN·m 1000 times too large: two of
them off by the same such factor are no coincidence. One alone may as well have been declared wrongly.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.analysis.motion.declared import beside, far_off
from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.covariance import scatter
from rig.analysis.tracing.fit.model import Solution
from rig.core.errors import UsageError
from rig.core.units import DEG

SURELY: Final = 5.0  # standard deviations above zero
NEAR: Final = 1.4  # how far a factor may be from that of a unit: what is declared is a design value
UNITS: Final[Mapping[float, str]] = {
    DEG: "angles seem to be in degrees, expected rad",
    1e3: "torques seem to be in mN·m, expected N·m",
    1e-3: "torques seem to be in kN·m, expected N·m",
}
"""By the factor that every one of K, J_m and J_l is then off by."""


def off_scale(s: Solution, name: str) -> tuple[str, ...]:
    """Notes on what is far from its declaration. Raises UsageError when two of them are off by the factor of a unit."""
    off = _factors(s)
    for unit, words in UNITS.items():
        alike = [n for n, (factor, _) in off.items() if 1 / NEAR < factor / unit < NEAR]
        if len(alike) > 1:
            found = " and ".join(f"{n} comes out as {beside(n, off[n][0] * off[n][1], off[n][1])}" for n in alike[:2])
            raise UsageError(f"{name}: {found}: {words}")
    return tuple(words for n, (factor, said) in off.items() if (words := far_off(n, factor * said, said)))


def _factors(s: Solution) -> dict[str, tuple[float, float]]:
    """Fitted over declared, and declared, of what is surely above zero."""
    spread = np.sqrt(np.maximum(np.diag(scatter(s)), 0.0))
    out = {}
    for name, coefficient in (("K", "compliance"), ("J_m", "J_m"), ("J_l", "J_l")):
        stated = [run.declared[name] for run in s.design.eq.runs if name in run.declared]
        value, said = s.value(coefficient), float(np.median(stated)) if stated else 0.0
        if said > 0 and value > SURELY * spread[INDEX[coefficient]] and value > 0:
            out[name] = ((1 / value if name == "K" else value) / said, said)
    return out
