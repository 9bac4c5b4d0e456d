"""An order of the motor that has another phase and another height in every run: a cage that slips, an oil film that
whirls, whatever goes round with the shaft but is not tied to it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.residual.binned import Halves
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Index, Rest
from rig.analysis.tracing.residual.lines import SPAN, highest, spectrum
from rig.analysis.tracing.residual.readings import in_columns, share, waves
from rig.analysis.tracing.residual.whose_order import WHOLE_ORDER, of_the_output
from rig.core.units import TURN
from rig.model.effect import Array

SHOWN: Final = 0.2  # of what is left of a run, in squares, that the order must take for the run to show it
RUNS: Final = 3  # that show it
NEAR: Final = 21  # orders tried beside the best one of the grid
WIDE: Final = 1.5  # highest speed among them over the lowest: else it may be a frequency


def own_phases(h: Halves, channel: str) -> Home | None:
    """The order that takes most where every run has a phase and a height of its own; None where it is a whole one, or
    too few runs of differing speed show it."""
    r = h.rest
    runs = [np.flatnonzero(r.run == run) for run in np.unique(r.run)]
    angle = r.at["motor_angle"]
    if not np.isfinite(angle).all():
        return None
    step = 0.5 / max(*(float(np.ptp(angle[rows])) / TURN for rows in runs), 1.0)
    first, last = SPAN["motor_angle"]
    orders = np.asarray(np.arange(1, int(min(last, highest(r, angle)) / step) + 1) * step, dtype=np.float64)
    if orders.size < 2 or orders[-1] < first:
        return None
    taken = np.sum([spectrum(angle[rows], r.e[rows], orders) / rows.size for rows in runs], axis=0)
    rough = float(orders[int(np.argmax(np.where(orders >= first, taken, 0.0)))])
    near = rough + step * np.linspace(-1.0, 1.0, NEAR)
    k = float(near[int(np.argmax([sum(_taken(r, runs, order)) for order in near]))])
    return None if abs(k - round(k)) < WHOLE_ORDER else _at(h, channel, runs, k)


def _taken(r: Rest, runs: Sequence[Index], k: float) -> list[float]:
    """Sum of squares that a wave of its own takes of each run."""
    e = r.e * np.exp(-1j * k * r.at["motor_angle"])
    return [2 * float(abs(e[rows].sum())) ** 2 / rows.size for rows in runs]


def _at(h: Halves, channel: str, runs: Sequence[Index], k: float) -> Home | None:
    r = h.rest
    squares = [float(r.e[rows] @ r.e[rows]) for rows in runs]
    took = zip(runs, _taken(r, runs, k), squares, strict=True)
    shown = [rows for rows, mine, all_of in took if mine > SHOWN * all_of]
    speeds = [float(np.mean(np.abs(r.at["speed"][rows]))) for rows in shown]
    if len(shown) < RUNS or max(speeds) < WIDE * min(speeds):
        return None

    def each_run(rest: Rest) -> Array:
        """Cosine and sine in every run that shows it, (n, 2·runs)."""
        of = [int(r.run[rows[0]]) for rows in shown]
        both = waves(rest.at["motor_angle"], k)
        return np.hstack([both * (rest.run == run)[:, None] for run in of])

    read = in_columns(each_run)
    return of_the_output(Home("motor_angle", channel, share(h, read), order=k, read=read), r)
