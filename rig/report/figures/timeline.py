"""The run over time: angle and reference, following error, speed, torques, one strip each under one time axis."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, band, columns, line, span
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT


class Strip(NamedTuple):
    """One quantity over time, kept as least and greatest per stretch of time."""

    curve: str
    name: str
    unit: str


STRIPS = (
    Strip("time.following_error", "Following error, reference less motor", "deg"),
    Strip("time.speed", "Motor speed", "rpm"),
    Strip("time.tau_m", "Motor torque", "N·m"),
    Strip("time.tau_l", "Torque at the load", "N·m"),
)


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses time.t (n,) s, time.theta_m_deg, time.theta_ref_deg (n,) deg, and *_min, *_max (n,) of every strip."""
    t = axis(curves, "time.t")
    if t is None:
        return None
    angle, reference = line(curves, "time.theta_m_deg", len(t)), line(curves, "time.theta_ref_deg", len(t))
    bands = [(strip, b) for strip in STRIPS if (b := band(curves, strip.curve, len(t))) is not None]
    with_angle = angle is not None or reference is not None
    if not (with_angle or bands):
        return None
    heights = [frame.pick(130, 120)] * with_angle + [frame.pick(92, 88)] * len(bands)
    figure, panels = sheet(frame, heights)
    if with_angle:
        _angle(panels[0], t, angle, reference)
    for panel, (strip, (low, high)) in zip(panels[with_angle:], bands, strict=True):
        _band(panel, frame, t, low, high)
        title(panel, strip.name, strip.unit)
    first, last = float(t.min()), float(t.max())
    ends = (0.0 if 0 < first < 0.01 * last else first, last)  # a run that starts a tick after zero still starts at zero
    for panel in panels:
        panel.set_xlim(*ends)
        panel.xaxis.set_major_locator(MaxNLocator(int(frame.pick(10, 5))))
    foot(panels[-1], "Time, s")
    return figure


def _angle(panel: Axes, t: Array, angle: Array | None, reference: Array | None) -> None:
    handles = []
    if angle is not None:
        handles += panel.plot(t, angle, color=LIGHT["forward"], lw=2.2, label="measured")
    if reference is not None:
        handles += panel.plot(t, reference, color=LIGHT["fit"], lw=1.1, ls=(0, (3, 3)), label="reference")
    title(panel, "Motor angle", "deg")
    key(panel, handles)


def _band(panel: Axes, frame: Frame, t: Array, low: Array, high: Array) -> None:
    """Between least and greatest, with an outline, so that a steady quantity is still a line."""
    x, least, greatest = columns(t, low, high, int(frame.width * 0.9))
    if (ends := span(least, greatest)) and ends[0] < 0 < ends[1]:
        panel.axhline(0, color=LIGHT["axis"], lw=1)
    panel.fill_between(x, least, greatest, facecolor=LIGHT["bar"], edgecolor=LIGHT["bar"], linewidth=0.8)
    panel.yaxis.set_major_locator(MaxNLocator(4))


def say(curves: Curves) -> str:
    """The figure in words."""
    t = axis(curves, "time.t")
    if t is None:
        return ""
    said = [f"The run over {plain(float(np.ptp(t)), 3)} s"]
    for strip in STRIPS:
        found = band(curves, strip.curve, len(t))
        if found is not None:
            low, high = plain(float(np.nanmin(found[0])), 3), plain(float(np.nanmax(found[1])), 3)
            said += [f"{strip.name.lower()} between {low} and {high} {strip.unit}"]
    return "; ".join(said) + "."


DRAWING = Drawing(
    "time",
    "The run over time",
    "Each strip spans the least and the greatest sample of each stretch of time, so that no peak is lost.",
    draw,
    say,
    full=True,
)
