"""What was there from one moment on: something lodged, slipped or broke."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from rig.analysis.tracing.rest.binned import Halves, solved
from rig.analysis.tracing.rest.home import Home
from rig.analysis.tracing.rest.joined import Rest
from rig.analysis.tracing.rest.readings import in_columns, share
from rig.model.effect import Array

LARGEST: Final = (1, 2, 4)  # orders of a wave generator that stand out: eccentricity, lobes, and what both gears make
ENDS: Final = 0.03  # of the rows on each side: of less a step is what one run has to itself


def since(h: Halves, channel: str, sense: Callable[[Rest], Array]) -> Home:
    """A step at one moment of the campaign, against the `sense` of the motion: the moment is where the sum of what is
    left, about its mean, is furthest from nothing."""
    r = h.rest
    order = np.argsort(r.at["time"], kind="stable")
    left = (h.alone[0] + h.alone[1]) / 2 * sense(r)
    gone = np.cumsum(left[order] - left.mean())
    n, k = left.size, np.arange(1, left.size + 1)
    strength = np.abs(gone) / np.sqrt(np.maximum(k * (n - k), 1) / n)
    strength[: int(ENDS * n)] = strength[n - int(ENDS * n) - 1 :] = 0.0
    moment = float(r.at["time"][order[int(np.argmax(strength))]])
    read = in_columns(lambda rest: ((rest.at["time"] > moment) * sense(rest))[:, None])
    return Home("time", channel, share(h, read), read=read)


def turned_since(h: Halves, channel: str) -> Home | None:
    """Another kinematic error from one run on: the wave generator slipped on its shaft, or was put in again. A slip
    within a run is a step of what is left as well."""
    r = h.rest
    left = (h.alone[0] + h.alone[1]) / 2
    starts = sorted(float(r.at["time"][r.run == run].min()) for run in np.unique(r.run))[1:]
    waves = _waves(r)
    after = {moment: r.at["time"] >= moment for moment in starts}
    taken = {moment: _taken(waves[rows], left[rows]) for moment, rows in after.items()}
    if not taken:
        return None
    moment = max(taken, key=lambda at: taken[at])
    read = in_columns(lambda rest: (rest.at["time"] >= moment)[:, None] * _waves(rest))
    return Home("time", channel, share(h, read), read=read)


def _waves(r: Rest) -> Array:
    """Waves of the largest orders of the motor angle, (n, 2k)."""
    return np.stack([f(order * r.at["motor_angle"]) for order in LARGEST for f in (np.cos, np.sin)], 1)


def _taken(waves: Array, left: Array) -> float:
    """Sum of squares they (n, k) take from what is left (n,)."""
    return float(np.sum((waves @ solved(waves.T @ waves, waves.T @ left)) ** 2))
