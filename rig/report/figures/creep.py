"""Creep of the locked gear while it is held under load, against the logarithm of time."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rig.report.figures.arrays import line
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses creep.time, creep.windup (n,): s and arcsec."""
    time = line(curves, "creep.time")
    windup = None if time is None else line(curves, "creep.windup", len(time))
    if time is None or windup is None or not (time > 0).any():
        return None
    shown = time > 0
    figure, (panel,) = sheet(frame, [frame.pick(160, 150)])
    panel.axhline(0, color=LIGHT["axis"], lw=1)
    panel.plot(np.log10(time[shown]), windup[shown], "o-", color=LIGHT["forward"], ms=3.5, lw=1.2)
    title(panel, "Wind-up the spring does not explain", "arcsec")
    foot(panel, "Logarithm of the time since arrival in s (0 is 1 s)")
    panel.margins(x=0.03)
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    time, windup = line(curves, "creep.time"), line(curves, "creep.windup")
    if time is None or windup is None:
        return "Creep of the locked gear against the logarithm of time."
    return (
        f"Creep of the locked gear held under load: {plain(np.nanmax(windup) - np.nanmin(windup), 2)} arcsec of "
        f"wind-up over {plain(np.nanmax(time), 2)} s."
    )


DRAWING = Drawing(
    "creep",
    "Creep at the holds",
    "Wind-up less torque over the local stiffness, in the direction of the load, mean of the holds: creep at constant "
    "torque and relaxation at constant wind-up come out alike. A straight line is so much per decade of time.",
    draw,
    say,
)
