"""One figure run by run: values with intervals, assemblies apart, changes marked."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from rig.catalogue.trend import Series
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT

NOTE = (
    "Each point is a run with its 95 % interval, in order of time; a thin line stands where the rig was assembled anew "
    "or another day began. The band is where a run of an unchanged gear stays in 99 of 100 cases, about the mean "
    "of the runs since the last change. A diamond is a run beyond it."
)


def drawing(series: Series) -> Drawing:
    """The course of one series; its dates stand below the axis."""
    days = [spot.row.started_utc[:10] for spot in series.spots]

    def draw(curves: Curves, frame: Frame) -> Figure | None:
        """Value with interval by number of the run; columns as `curves_of` makes them."""
        figure, panels = sheet(frame, [frame.pick(220, 200)])
        panel, x = panels[0], np.arange(1, len(days) + 1, dtype=float)
        value, low, high = curves["value"], curves["low"], curves["high"]
        level, limit = curves["level"], curves["limit"]
        panel.fill_between(x, level - limit, level + limit, color=LIGHT["bar-soft"], alpha=0.35, lw=0, step="mid")
        for k in np.flatnonzero(np.diff(curves["assembly"])):
            panel.axvline(k + 1.5, color=LIGHT["axis"], lw=0.8)
        panel.vlines(x, low, high, color=LIGHT["bar"], lw=1.4)
        changed = curves["changed"] > 0
        panel.plot(x[~changed], value[~changed], "o", ms=4.5, color=LIGHT["bar"])
        panel.plot(x[changed], value[changed], "D", ms=7.5, color=LIGHT["bad"])
        panel.set_xlim(0.5, len(days) + 0.5)
        panel.xaxis.set_major_locator(MaxNLocator(int(frame.pick(7, 3)), integer=True))
        panel.xaxis.set_major_formatter(FuncFormatter(lambda k, _: days[int(k) - 1] if 1 <= k <= len(days) else ""))
        title(panel, series.label, series.unit)
        foot(panel, "Runs in order of time, by their day")
        return figure

    def say(curves: Curves) -> str:
        """The figure in one sentence, for who does not see it."""
        value = curves["value"]
        return f"{series.label}, {plain(value.min(), 4)} to {plain(value.max(), 4)} {series.unit}: {series.sentence}."

    return Drawing("course", series.title, NOTE, draw, say)


def curves_of(series: Series) -> dict[str, Array]:
    """Columns of the series, NaN where there is no number."""
    spots = series.spots
    columns = {
        "value": [s.figure.value for s in spots],
        "low": [s.figure.low for s in spots],
        "high": [s.figure.high for s in spots],
        "level": [s.level for s in spots],
        "limit": [s.limit for s in spots],
        "assembly": [s.assembly for s in spots],
        "changed": [s.changed for s in spots],
    }
    return {name: np.asarray(values, dtype=np.float64) for name, values in columns.items()}
