"""Peak to peak against load: a point with its interval for every run, a line for every assembly, the band about it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rig.report.figures.arrays import line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT

LOOKS = (  # by depth: colour, marker, dash
    ("forward", "o", "solid"),
    ("level", "s", (0, (5, 2))),
    ("reverse", "D", (0, (7, 2.2))),
    ("mark", "^", (0, (2, 1.5))),
)
FLAT = 7.5  # N·m


class Points(NamedTuple):
    """One entry a run, all (n,): N·m, arcsec, arcsec, arcsec, mm, number of the assembly."""

    load: Array
    value: Array
    low: Array
    high: Array
    depth_mm: Array
    assembly: Array


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses load.load N·m, .value, .low, .high arcsec, .depth_mm, .assembly, all (n,), and band.load, .low, .high where
    there are any. None without two points.
    """
    found = _points(curves)
    if found is None:
        return None
    depths = np.unique(found.depth_mm)
    wide = depths.size > 1
    figure, (panel,) = sheet(frame, [frame.pick(290, 240)], keys=1 if wide and frame.narrow else 0)
    panel.axvline(FLAT, color=LIGHT["axis"], lw=1, ls=(0, (2, 3)))
    panel.margins(x=0.03)
    handles: list[Any] = []
    for k, mm in enumerate(depths):
        for number in np.unique(found.assembly[found.depth_mm == mm]):
            drawn = _assembly(panel, found, (found.depth_mm == mm) & (found.assembly == number), LOOKS[k % len(LOOKS)])
            drawn.set_label(f"{mm:+g} mm" if mm else "reference depth")
        handles.append(drawn)
    _band(panel, curves)
    panel.set_ylim(0, None)
    title(panel, "Peak to peak", "arcsec", keys=1 if wide and frame.narrow else 0)
    if wide:
        key(panel, handles, len(handles) if frame.narrow else 0)
    foot(panel, "Load on the output, N·m")
    return figure


def _points(curves: Curves) -> Points | None:
    """Runs with a load and a peak to peak; an interval that is not there has no width."""
    load = line(curves, "load.load")
    value = None if load is None else line(curves, "load.value", load.size)
    if load is None or value is None:
        return None
    there = np.isfinite(load) & np.isfinite(value)
    if there.sum() < 2:
        return None

    def beside(name: str, instead: Array) -> Array:
        got = line(curves, f"load.{name}", load.size)
        return (instead if got is None else np.where(np.isfinite(got), got, instead))[there]

    nothing = np.zeros(load.size)
    ends = beside("low", value), beside("high", value)
    return Points(load[there], value[there], *ends, beside("depth_mm", nothing), beside("assembly", nothing))


def _band(panel: Axes, curves: Curves) -> None:
    """Where single fittings at the reference depth lie."""
    load = line(curves, "band.load")
    low, high = (None if load is None else line(curves, f"band.{name}", load.size) for name in ("low", "high"))
    if load is None or low is None or high is None:
        return
    order = np.argsort(load)
    panel.fill_between(load[order], low[order], high[order], color=LIGHT[LOOKS[0][0]], alpha=0.13, lw=0)


def _assembly(panel: Axes, found: Points, here: Array, look: tuple[str, str, Any]) -> Any:
    colour, marker, dash = LIGHT[look[0]], look[1], look[2]
    x, y = found.load[here], found.value[here]
    panel.vlines(x, found.low[here], found.high[here], color=colour, lw=1.5)
    levels = np.unique(x)
    panel.plot(levels, [y[x == level].mean() for level in levels], color=colour, lw=1.3, ls=dash, alpha=0.75)
    return panel.plot(x, y, ls="none", marker=marker, ms=6, color=colour)[0]


def say(curves: Curves) -> str:
    """The figure in words."""
    found = _points(curves)
    if found is None:
        return ""
    first, last = int(np.argmin(found.load)), int(np.argmax(found.load))
    return (
        f"Peak to peak of the kinematic error against load, {found.load.size} runs: {plain(found.value[first], 3)} "
        f"arcsec at {found.load[first]:g} N·m, {plain(found.value[last], 3)} arcsec at {found.load[last]:g} N·m."
    )


DRAWING = Drawing(
    "loads",
    "Peak to peak against load",
    "A point with its 95 % interval for every run, a line for every assembly. The tinted band is where 95 of 100 "
    "single fittings of the wave generator at the reference depth lie; it takes a wave generator that was fitted there "
    "more than once.",
    draw,
    say,
)
