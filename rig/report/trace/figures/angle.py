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

PARTS = (  # angle and residual of each panel
    ("angle.deg", "angle", "Mean residual against motor angle"),
    ("turn.load_deg", "turn", "Mean residual of motor turns by load angle"),
)


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses angle.deg and turn.load_deg, each with .before_arcsec and .after_arcsec."""
    parts = [p for p in PARTS if line(curves, p[0]) is not None and line(curves, f"{p[1]}.before_arcsec") is not None]
    if not parts:
        return None
    figure, panels = sheet(frame, [frame.pick(140, 120)] * len(parts), keys=int(frame.narrow))
    for panel, (across, stem, name) in zip(panels, parts, strict=True):
        panel.axhline(0, color=LIGHT["axis"], lw=1)
        x = line(curves, across)
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
        title(panel, name, "arcsec", keys=int(frame.narrow and panel is panels[0]))
    key(panels[0], [handle({**BEFORE, "ls": "-"}, "before"), handle(AFTER, "after")], columns=2 * frame.narrow)
    foot(panels[-1], "Angle within one turn")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for _, stem, name in PARTS:
        pair = [line(curves, f"{stem}.{n}_arcsec") for n in ("before", "after")]
        sizes = [plain(float(np.nanmax(v) - np.nanmin(v)), 2) for v in pair if v is not None]
        if len(sizes) == 2:
            said.append(f"{name}: {sizes[0]} arcsec peak to peak before, {sizes[1]} after")
    return "; ".join(said) + "."


DRAWING = Drawing(
    "residual-angle",
    "Residual against angle",
    "Mean over all held-out runs. Against the load angle each point is one whole motor turn, so that what the motor "
    "angle does averages out. Slow runs turn the output only part of the way: not every load angle was there in every"
    " run. What changes sign between runs averages out here and shows above.",
    draw,
    say,
)
