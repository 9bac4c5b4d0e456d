"""What settles anew in every run: an amplifier that is switched on with it, a brake that lets go."""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.rest.binned import Halves
from rig.analysis.tracing.rest.home import Home
from rig.analysis.tracing.rest.joined import Rest
from rig.analysis.tracing.rest.readings import in_columns, share
from rig.model.effect import Array

CONSTANTS: Final = (0.6, 1.5, 4.0, 8.0, 16.0, 40.0)  # s
MOST: Final = 0.6  # of the excess: one number that foretells so much of it is no chance


def settled(h: Halves, channel: str) -> list[Home]:
    """One number that is gone exponentially with the time since each run began: the time constant that foretells most.
    Where runs begin at one angle, or a torque has acted since, those tell it as well, with many numbers: the one that
    does nearly as well with one is said first."""
    if not h.rest.timed:
        return []
    found = max((_within(h, channel, tau) for tau in CONSTANTS), key=lambda home: home.share)
    return [found] if found.first else []


def _within(h: Halves, channel: str, tau: float) -> Home:
    read = in_columns(lambda rest: np.exp(-_since_it_began(rest) / tau)[:, None])
    found = share(h, read)
    said = f"the time since each run began, with a time constant near {tau:.2g} s"
    return Home("time", channel, found, read=read, first=found > MOST, said=said)


def _since_it_began(r: Rest) -> Array:
    """Time of each row since its run did, s (n,)."""
    time, began = r.at["time"], np.zeros(r.e.size)
    for run in np.unique(r.run):
        mine = r.run == run
        began[mine] = time[mine].min()
    return np.asarray(time - began)
