"""Orders of what is left, before and after, in every channel that is not at its floor."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, columns, line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, log_axis, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT
from rig.report.trace.channels import CHANNELS, Channel
from rig.report.trace.figures.style import AFTER, BEFORE, handle


class Spectrum(NamedTuple):
    """Amplitudes of one channel by order, in the unit shown."""

    channel: Channel
    order: Array
    before: Array
    after: Array


def spectra(curves: Curves) -> list[Spectrum]:
    """Every channel whose spectrum is there."""
    found = []
    for c in CHANNELS:
        names = ("spectrum.motor_order", "spectrum.before_arcsec", "spectrum.after_arcsec")
        if c.letter != "A":
            names = ("orders.motor_order", f"orders.{c.letter}.before", f"orders.{c.letter}.after")
        order = axis(curves, names[0])
        pair = [None if order is None else line(curves, n, len(order)) for n in names[1:]]
        before, after = pair
        if order is not None and before is not None and after is not None and (before > 0).any() and (after > 0).any():
            found.append(Spectrum(c, order, before * c.scale, after * c.scale))
    return found


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses spectrum.motor_order, .before_arcsec, .after_arcsec (n,), and orders.motor_order, .<C>.before, .after."""
    found = spectra(curves)
    if not found:
        return None
    figure, panels = sheet(frame, [frame.pick(180, 160)] * len(found), keys=int(frame.narrow))
    for panel, s in zip(panels, found, strict=True):
        _panel(panel, s, frame)
        name = f"Residual of the {s.channel.name.lower()} {s.channel.short}"
        title(panel, name, s.channel.unit, keys=int(frame.narrow and panel is panels[0]))
    key(panels[0], [handle({**BEFORE, "ls": "-"}, "before"), handle(AFTER, "after")], columns=2 * frame.narrow)
    foot(panels[-1], "Order, cycles per motor turn")
    return figure


def _panel(panel: Axes, s: Spectrum, frame: Frame) -> None:
    high = float(max(np.nanmax(s.before), np.nanmax(s.after))) * 1.6
    low = max(float(np.nanpercentile(s.after[s.after > 0], 20)), high / 1e4)
    log_axis(panel, min(low, high / 10), high)
    bottom, _ = panel.get_ylim()
    place, _, _ = columns(s.order, s.order, s.order, int(frame.width))
    for values, style, alpha in ((s.before, BEFORE, 0.16), (s.after, AFTER, 0.22)):
        _, _, peaks = columns(s.order, values, values, int(frame.width))  # peaks stay when points share a pixel
        peaks = np.clip(peaks, bottom, None)
        panel.fill_between(place, bottom, peaks, color=style["color"], alpha=alpha, linewidth=0)
        panel.plot(place, peaks, color=style["color"], lw=1.1)
    panel.xaxis.set_major_locator(MaxNLocator(int(frame.pick(20, 8)), integer=True, steps=[1, 2, 5, 10]))
    panel.set_xlim(0, float(s.order.max()))
    panel.grid(axis="x", color=LIGHT["grid"], linewidth=0.6)


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for c, order, before, after in spectra(curves):
        top = int(np.nanargmax(before))
        said.append(
            f"{c.name}: highest before at order {plain(order[top], 4)} with {plain(before[top], 3)} {c.unit}, there "
            f"{plain(after[top], 2)} {c.unit} after"
        )
    return "Order spectrum of the residual. " + "; ".join(said) + "."


DRAWING = Drawing(
    "residual-orders",
    "Orders of the residual",
    "All held-out runs in one piece, amplitude of what the model leaves, in the channels that are not at their floor. "
    "Whole orders repeat with every motor turn, orders near 2.04, 4.08 ride on the flexspline, the first order of the "
    "output is 1/N at the left edge. Lines that change size from run to run show here with their average.",
    draw,
    say,
)
