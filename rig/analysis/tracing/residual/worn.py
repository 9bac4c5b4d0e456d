"""Friction that wears off on the way: what stood still has to be ground in, or oiled, anew."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from rig.analysis.tracing.residual.binned import Halves
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.past import since_turned, slid
from rig.analysis.tracing.residual.readings import in_columns, share
from rig.model.effect import Array

REACHES: Final = (2.0, 5.0, 12.0, 30.0, 80.0)  # rad of the motor within which all but a third of it is gone
LEADS: Final = (0.0, 2.0)  # s that a run may have turned before its first row: what settles is often left out
AT_FIRST: Final = 20  # rows that tell the speed there
MOST: Final = 0.6  # of the excess: one number that foretells so much of it is no chance


def worn_off(h: Halves, channel: str) -> list[Home]:
    """Friction more by one number at first, which is gone exponentially on the way since the motor rested, and since it
    last turned back: the reach that foretells most. Where runs begin at one angle that angle tells it as well, with a
    number for every place: the one that does nearly as well with one number is said first."""
    if channel != "M" or not np.isfinite(h.rest.at["motor_angle"]).all():
        return []
    leads = LEADS if h.rest.timed else LEADS[:1]
    ways = [lambda r, lead=lead: _since_rest(r, lead) for lead in leads]
    homes = [_within(h, way, reach) for way in (*ways, _since_turned) for reach in REACHES]
    return [max(homes, key=lambda home: home.share)]


def _within(h: Halves, way: Callable[[Rest], Array], reach: float) -> Home:
    read = in_columns(lambda rest: (rest.at["direction"] * np.exp(-way(rest) / reach))[:, None])
    found = share(h, read)
    return Home("memory", "M", found, read=read, first=found > MOST)


def _since_rest(r: Rest, lead: float) -> Array:
    """With what the motor went in `lead` s before the first row, at the speed it had there."""
    gone = slid(r.at["motor_angle"], r.at["time"], r.run)
    if not lead:
        return gone
    speeds = np.abs(r.at["speed"])
    for run in np.unique(r.run):
        mine = np.flatnonzero(r.run == run)
        gone[mine] += lead * float(np.median(speeds[mine[:AT_FIRST]]))
    return gone


def _since_turned(r: Rest) -> Array:
    return np.abs(since_turned(r.at["motor_angle"], r.at["direction"], r.run))
