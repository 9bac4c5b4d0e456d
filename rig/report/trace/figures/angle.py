"""Mean residual of the kinematic error against motor angle and against load angle, before and after."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MultipleLocator

from rig.report.figures.arrays import line, span
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT
from rig.report.trace.figures.style import AFTER, BEFORE, handle

PARTS = (("angle", "Mean residual against motor angle"), ("load_angle", "Mean residual against load angle"))


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses angle.deg, .before_arcsec, .after_arcsec and load_angle.* alike."""
    parts = [p for p in PARTS if all(line(curves, f"{p[0]}.{n}") is not None for n in ("deg", "before_arcsec"))]
    if not parts:
        return None
    figure, panels = sheet(frame, [frame.pick(140, 120)] * len(parts))
    for panel, (stem, name) in zip(panels, parts, strict=True):
        panel.axhline(0, color=LIGHT["axis"], lw=1)
        x = line(curves, f"{stem}.deg")
        pair = [line(curves, f"{stem}.{n}_arcsec") for n in ("before", "after")]
        for values, style in zip(pair, (BEFORE, AFTER), strict=True):
            if x is not None and values is not None and len(values) == len(x):
                panel.plot(x, values, color=style["color"], lw=1.4)
        ends = span(*pair)
        if ends is not None:
            room = 0.08 * (ends[1] - ends[0] or 1.0)
            panel.set_ylim(ends[0] - room, ends[1] + room)
        panel.set_xlim(0, 360)
        panel.xaxis.set_major_locator(MultipleLocator(frame.pick(45, 90)))
        panel.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}°"))
        title(panel, name, "arcsec")
    key(panels[0], [handle({**BEFORE, "ls": "-"}, "before"), handle(AFTER, "after")])
    foot(panels[-1], "Angle within one turn")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for stem, name in PARTS:
        pair = [line(curves, f"{stem}.{n}_arcsec") for n in ("before", "after")]
        sizes = [plain(float(np.nanmax(v) - np.nanmin(v)), 2) for v in pair if v is not None]
        if len(sizes) == 2:
            said.append(f"{name}: {sizes[0]} arcsec peak to peak before, {sizes[1]} after")
    return "; ".join(said) + "."


DRAWING = Drawing(
    "residual-angle",
    "Residual against angle",
    "Mean over all held-out runs in bins of 1°. Slow runs under no load turn only a part of the output round: then not "
    "every load angle was there in every run. What changes sign between runs averages out here and shows above.",
    draw,
    say,
)
