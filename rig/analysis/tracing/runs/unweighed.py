"""Runs whose manifest does not say what hung on the output: the shaft torque tells it, but for friction.

Unknown is not nothing: taken for no weight, 40 N·m would be the largest thing the model lacks. With it runs are told
apart and repeats found; friction goes into it too, so that what such a run's torque is on average stays its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.recording import Recording, mean_way
from rig.analysis.tracing.runs.told_once import Said

LEAST: Final = 0.5  # N·m, a weight
FRICTION: Final = 3.0  # times what the quietest runs carry: friction, and drag at speed
QUIETEST: Final = 0.1  # of the runs: under a sweep of loads a quarter is not without one
SAME: Final = 0.03  # relative: repeats with one weight on differ by less
SAME_LEAST: Final = 0.1  # N·m, the same of a small one


def weighed(runs: Sequence[Recording]) -> tuple[list[Recording], list[Said]]:
    """All runs; those of which no weight is stated, and that carry far more than others, with that as their weight."""
    free = [r for r in runs if "tau_l" in r.has and not r.locked and r.procedure != "standstill"]
    unsaid = [r for r in free if not r.load_stated]
    if not unsaid:
        return list(runs), []
    friction = FRICTION * float(np.quantile([abs(r.mean_torque) for r in free], QUIETEST))
    heavy = [r for r in unsaid if abs(r.mean_torque) > LEAST + friction * _one_way(r)]
    weights = _in_groups({r.name: -r.mean_torque for r in heavy})
    said = [
        Said(name, "", f"its conditions.tau_ext is not stated; the shaft torque says {weight:.3g} N·m, friction in it")
        for name, weight in weights.items()
    ]
    return [_carrying(r, weights[r.name]) if r.name in weights else r for r in runs], said


def _one_way(run: Recording) -> float:
    """1 where the motor never turned back, 0 where it went as far forth as back and friction is in no mean."""
    return abs(mean_way(run))


def _in_groups(weights: dict[str, float]) -> dict[str, float]:
    """With the mean of those that are nearly the same, N·m, by run."""
    out: dict[str, float] = {}
    group: list[str] = []
    for name in sorted(weights, key=lambda name: weights[name]):
        if group and weights[name] - weights[group[-1]] > max(SAME * abs(weights[name]), SAME_LEAST):
            group = []
        group.append(name)
        mean = float(np.mean([weights[one] for one in group]))
        out |= dict.fromkeys(group, mean)
    return out


def _carrying(run: Recording, weight: float) -> Recording:
    pieces = tuple(replace(piece, tau_ext=np.full(piece.t.size, weight)) for piece in run.pieces)
    return replace(run, pieces=pieces, said=f"{run.said} carrying {weight:.6g} N·m", load_known=False)
