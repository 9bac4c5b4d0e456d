"""Torques and the weights that were hung: none of the wrong sign or unit is fitted; another weight is told."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.recording import Recording, mean_way
from rig.analysis.tracing.runs.told_once import Said
from rig.analysis.turning.weight import is_another
from rig.core.errors import UsageError
from rig.model.effect import Array, Signals

WEIGHT: Final = 1.0  # N·m, by which hung weights must differ to be compared
SHARE: Final = (0.3, 3.0)  # of the weight that a torque may show: friction of a poor gear takes half of it
EVEN: Final = 0.3  # mean direction: a triangle that was cut short has a fifth
FEWEST: Final = 3  # runs of which one common zero can be known
READ: Final[Mapping[str, tuple[str, Callable[[Signals], Array]]]] = {
    "tau_l": ("τ_l", lambda s: s.tau_l),
    "tau_m": ("N·τ_m", lambda s: s.ratio * s.tau_m),
}


def refuse_odd_torques(runs: Sequence[Recording], name: str) -> None:
    """Raises UsageError when a torque does not follow the weights that were hung, as far as they are stated and differ:
    one that was read from the torque says nothing of it."""
    free = _weighable(runs)
    weight = np.array([-float(r.pieces[0].tau_ext[0]) for r in free])
    if weight.size == 0 or np.ptp(weight) < WEIGHT:
        return
    for channel, (words, read) in READ.items():
        if not all(channel in r.has for r in free):
            continue
        mean = np.array([_mean(r, read) for r in free])
        slope = float(np.polyfit(weight, mean, 1)[0])
        if not SHARE[0] < slope < SHARE[1]:
            raise UsageError(
                f"{name}: {words} changes by {slope:.3g} N·m for every N·m of weight, expected about 1; "
                f"its sign or unit is wrong, or that of the declared tau_ext{_but_for_one(free, weight, mean)}"
            )


def other_weights(runs: Sequence[Recording]) -> list[Said]:
    """Runs whose shaft torque shows another weight than stated, beside a zero that all have: they stay, and it is told.
    A manifest that is wrong, gravity of a load off its axis and a sensor's zero that moved look alike in one run."""
    free = [r for r in _weighable(runs) if "tau_l" in r.has and _turns(r)]
    stated = np.array([float(r.pieces[0].tau_ext[0]) for r in free])
    shown = np.array([-_without_friction(r) for r in free])
    common = float(np.median(shown - stated)) if len(free) >= FEWEST else 0.0
    return [
        Said(
            run.name,
            "",
            f"its shaft torque shows {said - common:+.3g} N·m on the output in the mean of both directions, its "
            f"manifest {_signed(there)} N·m: another weight, gravity of a load off its axis, or a zero that moved",
        )
        for run, said, there in zip(free, shown, stated, strict=True)
        if is_another(said - common, there)
    ]


def _weighable(runs: Sequence[Recording]) -> list[Recording]:
    """Those that turn forth and back under a weight that is stated: friction, which is none, goes out of their mean."""
    return [r for r in runs if r.load_stated and not r.locked and r.procedure != "standstill" and _both_ways(r)]


def _mean(run: Recording, read: Callable[[Signals], Array]) -> float:
    return float(np.mean(np.concatenate([read(p) for p in run.pieces])))


def _turns(run: Recording) -> bool:
    """Whether it goes either way at all."""
    return {1.0, -1.0} <= {float(way) for p in run.pieces for way in np.unique(np.sign(p.way))}


def _signed(torque: float) -> str:
    return f"{torque:+.3g}" if torque else "0"


def _without_friction(run: Recording) -> float:
    """τ_l, as much of it forth as back: less of a cut triangle would be left of a large friction. N·m"""
    tau_l, way = (np.concatenate([getattr(p, name) for p in run.pieces]) for name in ("tau_l", "way"))
    return float(np.mean([np.mean(tau_l[way > 0]), np.mean(tau_l[way < 0])]))


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
