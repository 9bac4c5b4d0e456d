"""How far the waveform at each speed is from that at standstill, the law through it, and the tolerance."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from rig.core.quantiles import Z95
from rig.report.figures.arrays import axis, line, scalar
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, key, log_axis, sheet, title
from rig.report.figures.direction import FIT_DASH
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses convergence.speed_rpm, .deviation, .u (m,), rpm and %; .law_rpm, .law (g,); .tolerance (1,), %."""
    speed = axis(curves, "convergence.speed_rpm")
    deviation = None if speed is None else line(curves, "convergence.deviation", len(speed))
    u = None if speed is None else line(curves, "convergence.u", len(speed))
    if speed is None or deviation is None or u is None or not (speed > 0).all() or not (u > 0).any():
        return None
    tolerance = scalar(curves, "convergence.tolerance")
    high = np.sqrt(np.fmax(deviation, 0.0) ** 2 + (Z95 * np.abs(u)) ** 2)
    low = np.sqrt(np.fmax(np.fmax(deviation, 0.0) ** 2 - (Z95 * u) ** 2, 0.0))
    floor = float(np.nanmin(high[high > 0])) / 6.0
    figure, (panel,) = sheet(frame, [frame.pick(250, 210)], keys=int(frame.narrow))
    log_axis(panel, floor, max(float(np.nanmax(high)), tolerance or 0.0) * 2.0)
    panel.set_xscale("log")
    panel.vlines(speed, np.fmax(low, floor), np.fmax(high, floor), color=LIGHT["forward"], lw=1.5)
    shown = np.where((deviation > floor) & (low > 0), deviation, np.nan)
    style = {"ls": "none", "marker": "o", "ms": 6, "color": LIGHT["forward"]}
    handles = panel.plot(speed, shown, label="measured, 95 %", **style)
    law_x = axis(curves, "convergence.law_rpm")
    law = None if law_x is None else line(curves, "convergence.law", len(law_x))
    if law_x is not None and law is not None and (law_x > 0).all():
        inside = np.where(law > floor, law, np.nan)
        handles += panel.plot(law_x, inside, color=LIGHT["fit"], lw=1.6, ls=FIT_DASH, label="fitted law")
    if tolerance is not None and tolerance > 0:
        handles.append(panel.axhline(tolerance, color=LIGHT["level"], lw=1.4, ls=(0, (5, 3)), label="tolerance"))
    title(panel, "Distance from standstill", "% of the rms", keys=int(frame.narrow))
    key(panel, handles, columns=3 * frame.narrow)
    panel.set_xlim(float(speed.min()) / 1.3, float(speed.max()) * 2.0)
    panel.xaxis.set_major_locator(FixedLocator(list(speed)))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: plain(x, 2)))
    foot(panel, "Motor speed, rpm")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    speed, deviation = axis(curves, "convergence.speed_rpm"), line(curves, "convergence.deviation")
    if speed is None or deviation is None:
        return ""
    said = ", ".join(f"{plain(d, 2)} % at {plain(s, 3)} rpm" for s, d in zip(speed, deviation, strict=False))
    return f"Distance of the waveform from that at standstill, on logarithmic scales: {said}."


DRAWING = Drawing(
    "speed-convergence",
    "How slow is slow enough",
    "Distance is the rms, over all orders, of the waveform less that extrapolated to standstill, in % of the latter's "
    "rms; the noise of single turns is taken off, whiskers are 95 % intervals, and those that reach the axis are upper "
    "limits. The law is the load's inertia on the gear's spring.",
    draw,
    say,
)
