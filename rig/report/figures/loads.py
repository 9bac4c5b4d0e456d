"""Peak to peak against load: a point with its interval for every run, a line for every assembly."""

from __future__ import annotations

from typing import Any

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


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses load.load N·m, .value, .low, .high arcsec, .depth_mm, .assembly, all (n,). None without two points."""
    load, value = line(curves, "load.load"), line(curves, "load.value")
    if load is None or value is None:
        return None
    assembly, depth = np.asarray(curves["load.assembly"]), np.asarray(curves["load.depth_mm"])
    depths = np.unique(depth)
    wide = depths.size > 1
    figure, (panel,) = sheet(frame, [frame.pick(290, 240)], keys=1 if wide and frame.narrow else 0)
    panel.axvline(FLAT, color=LIGHT["axis"], lw=1, ls=(0, (2, 3)))
    panel.margins(x=0.03)
    handles: list[Any] = []
    for k, mm in enumerate(depths):
        for number in np.unique(assembly[depth == mm]):
            here = (depth == mm) & (assembly == number)
            found = _assembly(panel, load, value, curves, here, LOOKS[k % len(LOOKS)])
            found.set_label(f"{mm:+g} mm" if mm else "reference depth")
        handles.append(found)
    panel.set_ylim(0, None)
    title(panel, "Peak to peak", "arcsec", keys=1 if wide and frame.narrow else 0)
    if wide:
        key(panel, handles, len(handles) if frame.narrow else 0)
    foot(panel, "Load on the output, N·m")
    return figure


def _assembly(panel: Axes, load: Array, value: Array, curves: Curves, here: Array, look: tuple[str, str, Any]) -> Any:
    colour, marker, dash = LIGHT[look[0]], look[1], look[2]
    x, y = load[here], value[here]
    low, high = np.asarray(curves["load.low"])[here], np.asarray(curves["load.high"])[here]
    panel.vlines(x, low, high, color=colour, lw=1.5)
    levels = np.unique(x)
    panel.plot(levels, [y[x == level].mean() for level in levels], color=colour, lw=1.3, ls=dash, alpha=0.75)
    return panel.plot(x, y, ls="none", marker=marker, ms=6, color=colour)[0]


def say(curves: Curves) -> str:
    """The figure in words."""
    load, value = line(curves, "load.load"), line(curves, "load.value")
    if load is None or value is None:
        return ""
    first, last = int(np.argmin(load)), int(np.argmax(load))
    return (
        f"Peak to peak of the kinematic error against load, {len(load)} runs: {plain(value[first], 3)} arcsec at "
        f"{load[first]:g} N·m, {plain(value[last], 3)} arcsec at {load[last]:g} N·m."
    )


DRAWING = Drawing("loads", "", "", draw, say)
