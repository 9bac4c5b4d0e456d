"""Orders of what is left in the kinematic error, before and after."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, columns, line
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, key, log_axis, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT
from rig.report.trace.figures.style import AFTER, BEFORE, handle


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses spectrum.motor_order, .before_arcsec, .after_arcsec (n,)."""
    order = axis(curves, "spectrum.motor_order")
    before = None if order is None else line(curves, "spectrum.before_arcsec", len(order))
    after = None if order is None else line(curves, "spectrum.after_arcsec", len(order))
    if order is None or before is None or after is None or not (before > 0).any() or not (after > 0).any():
        return None
    high = float(max(np.nanmax(before), np.nanmax(after))) * 1.6
    low = max(float(np.nanpercentile(after[after > 0], 20)), high / 1e4)
    figure, (panel,) = sheet(frame, [frame.pick(200, 190)])
    log_axis(panel, low, high)
    for values, style, alpha in ((before, BEFORE, 0.16), (after, AFTER, 0.22)):
        place, _, _ = columns(order, order, order, int(frame.width))
        _, _, peaks = columns(order, values, values, int(frame.width))  # peaks stay when points share a pixel
        peaks = np.clip(peaks, low, None)
        panel.fill_between(place, low, peaks, color=style["color"], alpha=alpha, linewidth=0)
        panel.plot(place, peaks, color=style["color"], lw=1.1)
    panel.xaxis.set_major_locator(MaxNLocator(int(frame.pick(20, 8)), integer=True, steps=[1, 2, 5, 10]))
    panel.set_xlim(0, float(order.max()))
    title(panel, "Amplitude of the residual", "arcsec")
    key(panel, [handle({**BEFORE, "ls": "-"}, "before"), handle(AFTER, "after")])
    panel.grid(axis="x", color=LIGHT["grid"], linewidth=0.6)
    foot(panel, "Order, cycles per motor turn")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    order, before = axis(curves, "spectrum.motor_order"), line(curves, "spectrum.before_arcsec")
    after = line(curves, "spectrum.after_arcsec")
    if order is None or before is None or after is None:
        return ""
    top = int(np.nanargmax(before))
    return (
        f"Order spectrum of the residual of the kinematic error: highest before at order {plain(order[top], 4)} with "
        f"{plain(before[top], 3)} arcsec, there {plain(after[top], 2)} arcsec after."
    )


DRAWING = Drawing(
    "residual-orders",
    "Orders of the residual",
    "All held-out runs in one piece, amplitude of what the model leaves in θ̃. Whole orders repeat with every motor "
    "turn, orders near 2.04, 4.08 ride on the flexspline, the first order of the output is 1/N at the left edge. "
    "Lines that change size from run to run show here with their average.",
    draw,
    say,
)
