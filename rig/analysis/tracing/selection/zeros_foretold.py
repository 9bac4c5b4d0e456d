"""Whether what is found foretells the zeros of unseen runs.

An effect that is the same all through a run stands in its mean, and most of a mean counts as the run's own: how loud
the rows are says little of it. What repeats of a run differ by in their means is known as well, and beside that the
means of unseen runs are told or not.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.fit.model import Design, Solution
from rig.analysis.tracing.floor.held_out import unseen
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.selection.selected import Selected
from rig.analysis.tracing.thresholds import PLAINLY
from rig.model.effect import Array

FEWEST: Final = 6  # unseen runs that turn freely
APART: Final = 2.0  # times what repeats' zeros differ by, RMS, that the zeros of unseen runs must be off
OWN: Final = 0.99  # of a mean: of a run that keeps more of it nothing is known


def are_foretold(p: Prepared, selected: Selected) -> bool:
    """Whether one of the channels that the names act in has zeros far apart in unseen runs, and most of that goes."""
    channels = {c for score in selected.scores for _, c in score.ground if c != "R"}
    return any(_in_channel(p, selected, c) for c in sorted(channels))


def _in_channel(p: Prepared, selected: Selected, channel: str) -> bool:
    scatter = p.eq.noise.local[channel]
    if not 0 < scatter < np.inf:
        return False
    before, after = (
        zeros(s, d, channel) / scatter
        for s, d in ((p.baseline, unseen(p.baseline, p.held_out)), (selected.solution, selected.held))
    )
    if before.size < FEWEST or float(np.mean(before**2)) < APART**2:
        return False
    return float(np.sum(before**2 - after**2)) > PLAINLY * float(np.sum(before**2 - 1.0))


def zeros(s: Solution, d: Design, channel: str) -> Array:
    """Mean of what `s` leaves of each block of `d` in that channel of a run that turns freely, (k,)."""
    shares = {key: d.eq.share_of_mean(key, y.size) for key, y in d.y.items() if key[1] == channel}
    free = [key for key, share in shares.items() if share < OWN and not d.eq.runs[key[0]].locked]
    return np.array([float(np.mean(d.residual(key, s.x))) / (1.0 - shares[key]) for key in free])
