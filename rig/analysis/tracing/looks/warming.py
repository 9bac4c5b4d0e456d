"""At means of the motor torque: where every repeat needs less than the one before it, none has a mean of its own.

How far a run's mean lies from the others' is read from repeats, and is the run's own. Of a drive that warms while all
conditions are gone through once, and then once more, that is the warming itself, and little of it is within a run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.floor.offsets import offset
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.runs.campaign import Campaign, looking
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.selected import Selected
from rig.model.effects.thermal_friction_drift import ThermalFrictionDrift

WARMING: Final = ThermalFrictionDrift.name
FEWEST: Final = 4  # pairs of repeats
WIDE: Final = 2.0  # times the noise, how far repeats lie apart


def wanted(selected: Selected) -> bool:
    """Whether the later of two repeats has less friction throughout, by far more than noise, and nothing says why."""
    s = selected.solution
    noise = s.design.eq.noise
    if WARMING in selected.names or not noise.local["M"] > WIDE * noise.sigma["M"]:
        return False
    runs = s.design.eq.runs
    pairs = [sorted(pair, key=lambda i: runs[i].start) for pair in repeats(runs, selected.p.split.fitted)]
    gone = [_friction(selected, b) - _friction(selected, a) for a, b in pairs if _turns_one_way(selected, a, b)]
    return len(gone) >= FEWEST and max(gone) < 0


def _turns_one_way(selected: Selected, a: int, b: int) -> bool:
    eq = selected.solution.design.eq
    return all((i, "M") in selected.solution.keys and abs(_way(eq.runs[i].pieces)) == 1.0 for i in (a, b))


def _way(pieces: Sequence[object]) -> float:
    return float(np.mean(np.concatenate([piece.way for piece in pieces])))  # type: ignore[attr-defined]


def _friction(selected: Selected, run: int) -> float:
    """What the baseline leaves in the mean of a run's motor torque, against its motion, N·m."""
    return offset(selected.solution, run, "M") * _way(selected.solution.design.eq.runs[run].pieces)


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """The same where no run's motor torque has a mean of its own. It counts where it names the warming beside all that
    had a name, and explains everything."""
    looks = [replace(run.look, steady=True) for run in so_far.p.campaign.runs]
    other, ranked = searched(prepare(looking(campaign, looks), hold_out))
    warm = not other.loud and other.names == {WARMING, *so_far.names}
    return (other, ranked) if warm else (so_far, found)
