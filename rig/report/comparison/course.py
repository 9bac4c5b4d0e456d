"""One figure run by run: values with intervals, assemblies apart, changes marked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter

from rig.catalogue.trend import Series
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT

BAND, EDGE = 1.0, 0.08  # of the span of the runs: what is shown of the band beyond them, and room beside

NOTE = (
    "Each point is a run with its 95 % interval, {order}; a thin line stands where the rig was assembled anew "
    "or another day began. The band is where a run of an unchanged gear stays in 99 of 100 cases, about the mean "
    "of the runs since the last change. A diamond is a run beyond it. A band that fills the panel is wider than that."
)


def order_of(days: Sequence[str]) -> str:
    """How runs of those days lie, "" the day of one that is undated: as the catalogue sorts them."""
    if all(days):
        return "in order of time"
    if not any(days):
        return "in the order of their names, for they are undated"
    return "in order of time, undated ones before the others in the order of their names"


def days_of(series: Series) -> list[str]:
    """The day of each run; "" where it is undated."""
    return [spot.row.started_utc[:10] for spot in series.spots]


def note(found: Sequence[Series]) -> str:
    """How the drawings of a page are read."""
    return NOTE.format(order=order_of([day for series in found for day in days_of(series)]))


def drawing(series: Series) -> Drawing:
    """The course of one series; its dates stand below the axis, the number of the run where it has none."""
    days = days_of(series)
    marks = [day or f"run {k}" for k, day in enumerate(days, 1)]

    def draw(curves: Curves, frame: Frame) -> Figure | None:
        """Value with interval by number of the run; columns as `curves_of` makes them."""
        figure, panels = sheet(frame, [frame.pick(220, 200)])
        panel, x = panels[0], np.arange(1, len(days) + 1, dtype=float)
        value, low, high = curves["value"], curves["low"], curves["high"]
        level, limit = curves["level"], curves["limit"]
        ends = np.column_stack([x - 0.5, x + 0.5]).ravel()  # so that a band of one run has a width
        below, above = (np.repeat(edge, 2) for edge in (level - limit, level + limit))
        panel.fill_between(ends, below, above, color=LIGHT["bar-soft"], alpha=0.35, lw=0)
        for k in np.flatnonzero(np.diff(curves["assembly"])):
            panel.axvline(k + 1.5, color=LIGHT["axis"], lw=0.8)
        panel.vlines(x, low, high, color=LIGHT["bar"], lw=1.4)
        changed = curves["changed"] > 0
        panel.plot(x[~changed], value[~changed], "o", ms=4.5, color=LIGHT["bar"])
        panel.plot(x[changed], value[changed], "D", ms=7.5, color=LIGHT["bad"])
        panel.set_xlim(0.5, len(days) + 0.5)
        panel.set_ylim(*_shown(curves))
        panel.xaxis.set_major_locator(
            FixedLocator(list(range(1, len(days) + 1, -(-len(days) // int(frame.pick(7, 3))))))
        )
        panel.xaxis.set_major_formatter(FuncFormatter(lambda k, _: marks[int(k) - 1] if 1 <= k <= len(days) else ""))
        title(panel, series.label, series.unit)
        foot(panel, f"Runs {order_of(days)}" + (", by their day" if all(days) else ""))
        return figure

    def say(curves: Curves) -> str:
        """The figure in one sentence, for who does not see it."""
        value = curves["value"]
        return f"{series.label}, {plain(value.min(), 4)} to {plain(value.max(), 4)} {series.unit}: {series.sentence}."

    return Drawing("course", series.title, note([series]), draw, say)


def _shown(curves: Curves) -> tuple[float, float]:
    """Ends of the axis: all runs with their intervals, and of the band what lies within BAND times their span; from two
    or three repeats it is so wide that no run could be seen in it."""
    ends = np.concatenate([curves[name] for name in ("value", "low", "high")])
    ends = ends[np.isfinite(ends)]
    low, high = (float(ends.min()), float(ends.max())) if ends.size else (0.0, 1.0)
    span = (high - low) or abs(high) or 1.0
    band = np.concatenate([curves["level"] - curves["limit"], curves["level"] + curves["limit"]])
    band = np.clip(band[np.isfinite(band)], low - BAND * span, high + BAND * span)
    return min([low, *band]) - EDGE * span, max([high, *band]) + EDGE * span


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
