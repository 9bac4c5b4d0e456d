"""Torques of the wrong sign or unit: seen before anything is fitted to them, by the weights that were hung."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.recording import Recording, mean_way
from rig.core.errors import UsageError
from rig.model.effect import Array, Signals

WEIGHT: Final = 1.0  # N·m, by which hung weights must differ to be compared
SHARE: Final = (0.3, 3.0)  # of the weight that a torque may show: friction of a poor gear takes half of it
EVEN: Final = 0.3  # mean direction: a triangle that was cut short has a fifth
READ: Final[Mapping[str, tuple[str, Callable[[Signals], Array]]]] = {
    "tau_l": ("τ_l", lambda s: s.tau_l),
    "tau_m": ("N·τ_m", lambda s: s.ratio * s.tau_m),
}


def refuse_odd_torques(runs: Sequence[Recording], name: str) -> None:
    """Raises UsageError when a torque does not follow the weights that were hung, as far as they are stated and differ:
    one that was read from the torque says nothing of it."""
    free = [r for r in runs if r.load_stated and not r.locked and r.procedure != "standstill" and _both_ways(r)]
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
                f"its sign or unit is wrong, or that of the declared tau_ext{_but_for_one(free, weight, mean)}"
            )


def _but_for_one(runs: Sequence[Recording], weight: Array, mean: Array) -> str:
    """The run without which the others go as they should, in words; "" where there is no such run."""
    for i, run in enumerate(runs):
        others = np.arange(weight.size) != i
        if np.ptp(weight[others]) >= WEIGHT:
            slope = float(np.polyfit(weight[others], mean[others], 1)[0])
            if SHARE[0] < slope < SHARE[1]:
                return f"; without {run.name} it is {slope:.3g}"
    return ""


def _both_ways(run: Recording) -> bool:
    """Whether friction, which is no weight, goes out of a run's mean."""
    return abs(mean_way(run)) < EVEN
