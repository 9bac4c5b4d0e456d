"""Simulated steady turning at constant torque: θ̃ over one turn beside the pure error, what the spring adds, orders."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Curves, Drawing, Frame, angle_axis, key, sheet, title
from rig.report.figures.kinematic_error import closed
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses steady.theta_deg (G,), steady.total, steady.pure, steady.flexible, arcsec, and steady.torque, N·m, all (G,).

    None without the first two.
    """
    theta = axis(curves, "steady.theta_deg")
    total = None if theta is None else line(curves, "steady.total", len(theta))
    if theta is None or total is None:
        return None
    pure, flexible = line(curves, "steady.pure", len(theta)), line(curves, "steady.flexible", len(theta))
    torque = line(curves, "steady.torque", len(theta))
    parts = (("Bending of the gear θ̃_s", "arcsec", flexible), ("Shaft torque less its mean", "N·m", torque))
    below = [(name, unit, y) for name, unit, y in parts if y is not None]
    heights = [frame.pick(250, 210), *[frame.pick(96, 86)] * len(below)]
    figure, panels = sheet(frame, heights, keys=1)
    handles = panels[0].plot(*closed(theta, total), color=LIGHT["bar"], lw=1.8, label="θ̃ at this speed")
    if pure is not None:
        style = {"color": LIGHT["fit"], "ls": (0, (5, 2)), "lw": 1.6}
        handles += panels[0].plot(*closed(theta, pure), label="pure θ̃_p", **style)
    title(panels[0], "Kinematic error", "arcsec", keys=1)
    key(panels[0], handles, columns=2)
    for panel, (name, unit, values) in zip(panels[1:], below, strict=True):
        panel.axhline(0, color=LIGHT["axis"], lw=1)
        panel.plot(*closed(theta, values), color=LIGHT["bar"], lw=1.6)
        title(panel, name, unit)
    angle_axis(panels, frame)
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    total, pure = line(curves, "steady.total"), line(curves, "steady.pure")
    if total is None:
        return ""
    said = f"Simulated kinematic error over one turn of the wave generator, {plain(float(np.ptp(total)), 3)} arcsec"
    beside = "" if pure is None else f", beside the pure error, {plain(float(np.ptp(pure)), 3)} arcsec"
    return f"{said} peak to peak{beside}."


DRAWING = Drawing(
    "simulated",
    "Simulated kinematic error at constant torque",
    "Equations 6 and 7 in their steady state, over the angle of the wave generator. Means are taken off: they are "
    "wind-up under friction and load. What lies between the two curves is the gear bending under the load's inertia.",
    draw,
    say,
)
