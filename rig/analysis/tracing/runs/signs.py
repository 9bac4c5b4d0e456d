"""Sensors of the wrong sign or unit: seen before anything is fitted to them, by what a gear cannot do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.covariance import scatter
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.runs.recording import Recording
from rig.core.errors import UsageError
from rig.model.effect import Array, Signals

ALONG: Final = 0.05  # how far θ_l may be from θ_m/N over a run: kinematic error and wind-up take a hundredth of it
WEIGHT: Final = 1.0  # N·m, by which hung weights must differ to be compared
SHARE: Final = (0.3, 3.0)  # of the weight that a torque may show: friction of a poor gear takes half of it
EVEN: Final = 0.3  # mean direction: a triangle that was cut short has a fifth
SURELY: Final = 5.0  # standard deviations below zero
READ: Final[Mapping[str, tuple[str, Callable[[Signals], Array]]]] = {
    "tau_l": ("τ_l", lambda s: s.tau_l),
    "tau_m": ("N·τ_m", lambda s: s.ratio * s.tau_m),
}
NEGATIVE: Final[Mapping[str, tuple[tuple[str, ...], str]]] = {
    "τ_m": (("tau_c",), "the friction of the motor comes out negative"),
    "τ_l": (("compliance", "J_l"), "stiffness of the gear and inertia of the load both come out negative"),
}
"""By sensor: coefficients that its sign turns over together, and what they are."""


def odd_angles(run: Recording) -> str | None:
    """What is wrong with the two angles of a run that turns freely, if they do not go together as 1:N."""
    if run.locked or run.procedure == "standstill" or not {"theta_m", "theta_l"} <= run.has:
        return None
    went = [(p.theta_m - p.theta_m.mean(), p.theta_l - p.theta_l.mean()) for p in run.pieces]
    slope = run.ratio * float(sum(m @ x for m, x in went)) / max(float(sum(m @ m for m, _ in went)), 1e-300)
    if abs(slope - 1) < ALONG:
        return None
    return f"θ_l goes {slope:.4g} of θ_m/{run.ratio:g}, expected 1: a sign, a unit or the ratio is wrong"


def refuse_odd_torques(runs: Sequence[Recording], name: str) -> None:
    """Raises UsageError when a torque does not follow the weights that were hung, as far as they differ."""
    free = [r for r in runs if not r.locked and r.procedure != "standstill" and _both_ways(r)]
    weight = np.array([-float(r.pieces[0].tau_ext[0]) for r in free])
    if weight.size == 0 or np.ptp(weight) < WEIGHT:
        return
    for channel, (words, read) in READ.items():
        if not all(channel in r.has for r in free):
            continue
        mean = np.array([np.mean(np.concatenate([read(p) for p in r.pieces])) for r in free])
        slope = float(np.polyfit(weight, mean, 1)[0])
        if not SHARE[0] < slope < SHARE[1]:
            raise UsageError(
                f"{name}: {words} changes by {slope:.3g} N·m for every N·m of weight, expected about 1; "
                "its sign or unit is wrong, or that of the declared tau_ext"
            )


def _both_ways(run: Recording) -> bool:
    """Whether friction, which is no weight, goes out of a run's mean."""
    return abs(float(np.mean(np.concatenate([p.way for p in run.pieces])))) < EVEN


def refuse_negative(s: Solution, name: str) -> None:
    """Raises UsageError when a sensor's sign is the other way round than the rest of the campaign `name` says."""
    spread = np.sqrt(np.maximum(np.diag(scatter(s)), 0.0))
    for sensor, (coefficients, words) in NEGATIVE.items():
        if all(s.value(c) < -SURELY * spread[INDEX[c]] and s.value(c) < 0.0 for c in coefficients):
            raise UsageError(f"{name}: {words}; {sensor} seems to have the other sign than equations 6 and 7 give it")
