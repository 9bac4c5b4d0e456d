"""What was there from one moment on: something lodged, slipped or broke."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.residual.binned import Halves, solved
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Index, Rest
from rig.analysis.tracing.residual.readings import in_columns, share
from rig.core.units import TURN
from rig.model.effect import Array

LARGEST: Final = (1, 2, 4)  # orders of a wave generator that stand out: eccentricity, lobes, and what both gears make
ENDS: Final = 0.03  # of the rows on each side: of less a step is what one run has to itself
MOMENTS: Final = 1000  # tried: a step of a minute's run is told to two seconds
JUST: Final = 0.08  # of a run: a loop opens over some of the way since it turned back
PARTS: Final = 50  # of a run, each of which goes one way or the other
FAINTEST: Final = 1e-4  # of the rows, what a step must keep of itself beside the baseline


def since(h: Halves, channel: str, sense: Callable[[Rest], Array]) -> Home | None:
    """A step at one moment of the campaign, against the `sense` of the motion: the moment is where it takes most of
    what is left, the baseline fitted beside it. By itself the baseline has taken on most of a step that came before
    all fast runs. None where the motor turns back just then: of a loop that one run goes round, a way is above the
    other from there on."""
    moment = _moment(h.rest, sense(h.rest) * h.rest.worth)
    if _turns_back(h.rest, moment):
        return None
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


def _turns_back(r: Rest, moment: float) -> bool:
    """Whether the run that goes on at that moment, s, turns back within JUST of it."""
    t, way = r.at["time"], r.at["direction"]
    for run in np.unique(r.run):
        mine = r.run == run
        first, last = float(t[mine].min()), float(t[mine].max())
        if first < moment < last:
            order = np.argsort(t[mine], kind="stable")
            parts = np.array_split(way[mine][order], PARTS)
            most = np.sign([part.mean() if part.size else 0.0 for part in parts])
            back = (np.flatnonzero(most[1:] * most[:-1] < 0) + 1) / PARTS
            return bool(np.any(np.abs(back - (moment - first) / (last - first)) < JUST))
    return False


def _after(x: Array, at: Index) -> Array:
    """Sums of the rows (n, ...) after each of those places."""
    sums = np.cumsum(x, 0)
    return np.asarray(sums[-1] - sums[at])


def turned_since(h: Halves, channel: str) -> Home | None:
    """Another kinematic error from one run on: the wave generator slipped on its shaft, or was put in again. A slip
    within a run is a step of what is left as well. Not where only lock tests come after: there the motor's angle goes
    with the torque."""
    r = h.rest
    left = (h.alone[0] + h.alone[1]) / 2
    starts = sorted(float(r.at["time"][r.run == run].min()) for run in np.unique(r.run))[1:]
    waves = _waves(r) * r.worth[:, None]
    after = {moment: rows for moment in starts if _comes_round(r, rows := r.at["time"] >= moment)}
    taken = {moment: _taken(waves[rows], left[rows]) for moment, rows in after.items()}
    if not taken:
        return None
    moment = max(taken, key=lambda at: taken[at])
    read = in_columns(lambda rest: (rest.at["time"] >= moment)[:, None] * _waves(rest))
    return Home("time", channel, share(h, read), read=read)


def _comes_round(r: Rest, rows: npt.NDArray[np.bool_]) -> bool:
    """Whether a run among those rows turns the motor once."""
    angle, run = r.at["motor_angle"][rows], r.run[rows]
    return any(np.ptp(angle[run == one]) > TURN for one in np.unique(run))


def _waves(r: Rest) -> Array:
    """Waves of the largest orders of the motor angle, (n, 2k)."""
    return np.stack([f(order * r.at["motor_angle"]) for order in LARGEST for f in (np.cos, np.sin)], 1)


def _taken(waves: Array, left: Array) -> float:
    """Sum of squares they (n, k) take from what is left (n,)."""
    return float(np.sum((waves @ solved(waves.T @ waves, waves.T @ left)) ** 2))
