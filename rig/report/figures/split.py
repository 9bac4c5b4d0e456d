"""Direction split: the part of the error that is the same both ways, and the part that changes sign with direction."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Curves, Drawing, Frame, angle_axis, sheet, title
from rig.report.figures.kinematic_error import closed
from rig.report.numbers import plain
from rig.report.palette import LIGHT

PARTS = (("ke.pure", "E, same in both directions"), ("ke.direction", "O, changes sign with direction"))


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses ke.theta_deg, ke.pure, ke.direction (G,), arcsec. None without a direction part: one way tells nothing."""
    theta = axis(curves, "ke.theta_deg")
    if theta is None or line(curves, "ke.direction", len(theta)) is None:
        return None
    parts = [(v, name) for c, name in PARTS if (v := line(curves, c, len(theta))) is not None]
    figure, panels = sheet(frame, [frame.pick(150, 130)] * len(parts))
    for panel, (values, name) in zip(panels, parts, strict=True):
        panel.axhline(0, color=LIGHT["axis"], lw=1)
        panel.plot(*closed(theta, values), color=LIGHT["bar"], lw=1.6)
        title(panel, name, "arcsec")
    angle_axis(panels, frame)
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for name, words in PARTS:
        values = line(curves, name)
        if values is not None:
            said.append(f"{words}: peak to peak {plain(float(np.nanmax(values) - np.nanmin(values)), 3)} arcsec")
    return "Kinematic error split by direction. " + "; ".join(said) + "."


DRAWING = Drawing(
    "direction",
    "Direction split",
    "E is half the sum of both directions and is taken as the pure kinematic error. O is half their "
    "difference: wind-up under friction, lost motion, delay between the two encoders. "
    "The constant part of O, the direction offset, is a figure of its own and is taken out here.",
    draw,
    say,
)
