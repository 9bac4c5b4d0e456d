"""What was there from one moment on: something lodged, slipped or broke."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from rig.analysis.tracing.residual.binned import Halves, solved
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Index, Rest
from rig.analysis.tracing.residual.readings import in_columns, share
from rig.model.effect import Array

LARGEST: Final = (1, 2, 4)  # orders of a wave generator that stand out: eccentricity, lobes, and what both gears make
ENDS: Final = 0.03  # of the rows on each side: of less a step is what one run has to itself
MOMENTS: Final = 1000  # tried: a step of a minute's run is told to two seconds
FAINTEST: Final = 1e-4  # of the rows, what a step must keep of itself beside the baseline


def since(h: Halves, channel: str, sense: Callable[[Rest], Array]) -> Home:
    """A step at one moment of the campaign, against the `sense` of the motion: the moment is where it takes most of
    what is left, the baseline fitted beside it. By itself the baseline has taken on most of a step that came before
    all fast runs."""
    moment = _moment(h.rest, sense(h.rest) * h.rest.worth)
    read = in_columns(lambda rest: ((rest.at["time"] > moment) * sense(rest))[:, None])
    return Home("time", channel, share(h, read), read=read)


def _moment(r: Rest, sense: Array) -> float:
    """When a step of `sense` (n,) takes most, s, beside zeros of the runs and the baseline's columns."""
    order = np.argsort(r.at["time"], kind="stable")
    zeros = (r.whole.run[:, None] == np.arange(r.whole.runs.size if r.own_zeros else 0)).astype(float)
    z, step, e = np.hstack([zeros, r.z])[order], sense[order], r.e[order]
    normal = z.T @ z
    normal[zeros.shape[1] :, zeros.shape[1] :] += r.known * len(z)
    ends = max(int(ENDS * len(z)), 2)
    at = np.union1d(np.arange(ends, len(z) - ends, max(len(z) // MOMENTS, 1)), np.flatnonzero(np.diff(r.run[order])))
    at = at[(at >= ends) & (at < len(z) - ends)]
    if not at.size:
        return float("inf")
    along, across, own = (_after(step * e, at), _after(step[:, None] * z, at), _after(step**2, at))
    taken = solved(normal, np.column_stack([z.T @ e, across.T]))
    left, size = along - across @ taken[:, 0], own - np.sum(across * taken[:, 1:].T, 1)
    gain = np.where(size > FAINTEST * len(z), left**2 / np.maximum(size, FAINTEST * len(z)), 0.0)
    last, t = int(at[int(np.argmax(gain))]), r.at["time"][order]
    return float(t[last] + t[last + 1]) / 2  # unseen runs may lie between: it was before, in or behind them


def _after(x: Array, at: Index) -> Array:
    """Sums of the rows (n, ...) after each of those places."""
    sums = np.cumsum(x, 0)
    return np.asarray(sums[-1] - sums[at])


def turned_since(h: Halves, channel: str) -> Home | None:
    """Another kinematic error from one run on: the wave generator slipped on its shaft, or was put in again. A slip
    within a run is a step of what is left as well."""
    r = h.rest
    left = (h.alone[0] + h.alone[1]) / 2
    starts = sorted(float(r.at["time"][r.run == run].min()) for run in np.unique(r.run))[1:]
    waves = _waves(r) * r.worth[:, None]
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
