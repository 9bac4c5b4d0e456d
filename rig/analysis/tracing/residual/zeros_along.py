"""Zeros of runs along something: how far those of unseen runs are foretold by a curve through the fitted ones'."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import zero
from rig.analysis.tracing.residual.drifting_zeros import LEFT, PLAINER, constants, falling, foretold, times
from rig.model.effect import Array


@dataclass(frozen=True)
class Along:
    """By how much the curve differs between the runs [rad], and what of the scatter of unseen zeros it foretells."""

    size: float
    foretold: float


def along(
    s: Solution,
    fitted: Sequence[int],
    unseen: Sequence[int],
    curve: Callable[[Sequence[int]], Array],
    instead: Sequence[Array],
) -> Along | None:
    """Of θ̃'s zeros by the columns that `curve` makes of runs, (n, k); None where it foretells too little, or where
    columns of the fitted runs that may shift them `instead` (n, k each), or a drift, do half as well."""
    zeros, wanted = (np.array([zero(s, i, "A") for i in runs]) for runs in (fitted, unseen))
    here, there = curve(fitted), curve(unseen)
    guess, x, own = foretold(here, there, zeros)
    spread, left = (float(np.sqrt(np.mean((wanted - by) ** 2))) for by in (zeros.mean(), guess))
    since = times(s.design.eq, fitted)
    drifts = [falling(since, tau) for tau in constants(max(float(np.ptp(since)), 1.0))]
    rival = min(foretold(z, z, zeros)[2] for z in (*instead, *drifts))
    if left > LEFT * spread or own > PLAINER * rival:
        return None
    return Along(float(np.ptp(np.concatenate([here, there]) @ x)), 1 - (left / spread) ** 2)
