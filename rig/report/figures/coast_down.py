"""Speed against time once the torque is gone, every coast, and the law through them."""

from __future__ import annotations

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rig.report.figures.arrays import axis, line, rows, thin
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.figures.direction import FIT_DASH
from rig.report.numbers import plain
from rig.report.palette import LIGHT

MOST = 40  # coasts drawn


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses coast.t (n,), s; coast.speed_rpm (C, n) and coast.law_rpm (n,), rpm. None without a coast."""
    t = axis(curves, "coast.t")
    coasts = None if t is None else rows(curves, "coast.speed_rpm", len(t))
    if t is None or coasts is None:
        return None
    figure, (panel,) = sheet(frame, [frame.pick(240, 200)])
    shown = thin(coasts, MOST)
    lines = [np.column_stack((1e3 * t, c))[np.isfinite(c)] for c in shown]
    panel.add_collection(LineCollection(lines, colors=LIGHT["forward-soft"], linewidths=0.9, alpha=0.8))
    panel.autoscale_view()
    handles = [Line2D([], [], color=LIGHT["forward-soft"], lw=1.4, label=f"{len(shown)} coasts")]
    law = line(curves, "coast.law_rpm", len(t))
    if law is not None:
        handles += panel.plot(1e3 * t, law, color=LIGHT["fit"], lw=2.0, ls=FIT_DASH, label="law, mean numbers")
    title(panel, "Motor speed, in the direction of motion", "rpm")
    key(panel, handles)
    panel.set_xlim(1e3 * float(t.min()), 1e3 * float(t.max()))
    foot(panel, "Time since the torque was taken off, ms")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    t = axis(curves, "coast.t")
    if t is None:
        return ""
    coasts = rows(curves, "coast.speed_rpm", len(t))
    count = 0 if coasts is None else len(coasts)
    return f"Speed of {count} coasts over {plain(1e3 * float(np.ptp(t)), 3)} ms, falling under friction alone."


DRAWING = Drawing(
    "coast-down",
    "Coast-down",
    "Nothing drives the motor: friction alone slows it down. The waves on the curves are the load swinging on the gear "
    "and the kinematic error pushing; they differ from coast to coast. The law is Coulomb and viscous friction.",
    draw,
    say,
)
