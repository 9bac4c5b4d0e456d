"""An order of the motor that has another phase and another height in every run: a cage that slips, an oil film that
whirls, whatever goes round with the shaft but is not tied to it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.residual.binned import Halves
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Index, Rest
from rig.analysis.tracing.residual.lines import LOWEST, SPAN, highest, spectrum
from rig.analysis.tracing.residual.readings import Reading, in_columns, share, waves
from rig.analysis.tracing.residual.whose_order import WHOLE_ORDER, of_the_output
from rig.core.units import TURN
from rig.model.effect import Array

SHOWN: Final = 0.2  # of what is left of a run, in squares, that the order must take for the run to show it
RUNS: Final = 3  # that show it
NEAR: Final = 21  # orders tried beside the best one of the grid
BOTH: Final = 0.2  # of a run's rows, the least that it goes each way
WIDE: Final = 1.5  # highest speed among them over the lowest: else it may be a frequency


def own_phases(h: Halves, channel: str) -> Home | None:
    """The order that takes most where every run has a phase and a height of its own; None where it is a whole one, or
    too few runs of differing speed show it."""
    if (order := found(h.rest)) is None:
        return None
    k, shown = order
    read = each_run(h.rest, shown, k)
    return of_the_output(Home("motor_angle", channel, share(h, read), order=k, read=read), h.rest)


def found(r: Rest) -> tuple[float, list[Index]] | None:
    """The order, and the rows of each run that shows it."""
    runs = [np.flatnonzero(r.run == run) for run in np.unique(r.run)]
    angle = r.at["motor_angle"]
    if not np.isfinite(angle).all():
        return None
    step = 0.5 / max(*(float(np.ptp(angle[rows])) / TURN for rows in runs), 1.0)
    first, last = SPAN["motor_angle"]
    orders = np.asarray(np.arange(1, int(min(last, highest(r, angle)) / step) + 1) * step, dtype=np.float64)
    if orders.size < 2 or orders[-1] < first:
        return None
    took = np.sum([spectrum(angle[rows], r.e[rows], orders) / rows.size for rows in runs], axis=0)
    rough = float(orders[int(np.argmax(np.where(orders >= first, took, 0.0)))])
    near = rough + step * np.linspace(-1.0, 1.0, NEAR)
    k = float(near[int(np.argmax([sum(taken(r, runs, order)) for order in near]))])
    if abs(k - round(k)) < WHOLE_ORDER:
        return None
    shown = _shown(r, runs, k)
    told = _speeds_differ(r, shown) or all(turns_back(r, rows) for rows in shown) if len(shown) >= RUNS else False
    return (k, shown) if told else None


def taken(r: Rest, runs: Sequence[Index], k: float, name: str = "motor_angle") -> list[float]:
    """Sum of squares that a wave of its own takes of each run, `k` of a radian of that coordinate."""
    e = r.e * np.exp(-1j * k * r.at[name])
    return [2 * float(abs(e[rows].sum())) ** 2 / rows.size for rows in runs]


def line_for_a_while(h: Halves, channel: str) -> Home | None:
    """A frequency in the loudest run, which goes both ways, and in those others that show it: what shakes a rig for a
    minute or two is in one run, or in a few of one speed. None where that run does not tell it from an order."""
    r = h.rest
    runs = [np.flatnonzero(r.run == run) for run in np.unique(r.run)]
    loudest = max(runs, key=lambda rows: float(r.e[rows] @ r.e[rows]))
    t = TURN * r.at["time"]
    top = highest(r, t)
    step = 0.25 * TURN / max(float(np.ptp(t[loudest])), 1e-9)
    if not turns_back(r, loudest) or not LOWEST + 2 * step < top < np.inf:
        return None
    hz = np.asarray(np.arange(1, int(top / step) + 1) * step, dtype=np.float64)
    heights = spectrum(t[loudest], r.e[loudest], hz)
    rough = float(hz[int(np.argmax(np.where(hz >= LOWEST, heights, 0.0)))])
    near = TURN * (rough + step * np.linspace(-1.0, 1.0, NEAR))
    k = float(near[int(np.argmax([taken(r, [loudest], one, "time")[0] for one in near]))])
    if not (shown := _shown(r, runs, k, "time")):
        return None
    read = each_run(r, shown, k, "time")
    return Home("time_periodic", channel, share(h, read), frequency_hz=k / TURN, read=read)


def _speeds_differ(r: Rest, runs: Sequence[Index]) -> bool:
    speeds = [float(np.mean(np.abs(r.at["speed"][rows]))) for rows in runs]
    return max(speeds) >= WIDE * min(speeds)


def turns_back(r: Rest, rows: Index) -> bool:
    """Whether a run goes both ways: a wave of the angle is gone through backward then, and one of the time is not."""
    ahead = float(np.mean(r.at["direction"][rows] > 0))
    return BOTH < ahead < 1.0 - BOTH


def _shown(r: Rest, runs: Sequence[Index], k: float, name: str = "motor_angle") -> list[Index]:
    squares = [float(r.e[rows] @ r.e[rows]) for rows in runs]
    took = taken(r, runs, k, name)
    return [rows for rows, mine, left in zip(runs, took, squares, strict=True) if mine > SHOWN * left]


def each_run(r: Rest, shown: Sequence[Index], k: float, name: str = "motor_angle") -> Reading:
    """Cosine and sine in every run that shows it, (n, 2·runs)."""
    of = [int(r.run[rows[0]]) for rows in shown]

    def columns(rest: Rest) -> Array:
        both = waves(rest.at[name], k)
        return np.hstack([both * (rest.run == run)[:, None] for run in of])

    return in_columns(columns)
