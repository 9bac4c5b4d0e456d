"""Fine order spectrum: what lies between the whole orders is not a function of the wave-generator angle alone."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, columns, line
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, log_axis, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses spectrum.order, spectrum.amplitude (n,), arcsec. None without two positive amplitudes."""
    order = axis(curves, "spectrum.order")
    amplitude = None if order is None else line(curves, "spectrum.amplitude", len(order))
    if order is None or amplitude is None or (amplitude > 0).sum() < 2:
        return None
    positive = amplitude[amplitude > 0]
    low, high = float(np.percentile(positive, 1)), float(positive.max()) * 1.6
    low = max(min(low, high / 100), high / 1e7)
    figure, (panel,) = sheet(frame, [frame.pick(220, 200)])
    log_axis(panel, low, high)
    _, _, peaks = columns(order, amplitude, amplitude, int(frame.width * 4))  # peaks stay when points share a pixel
    places, _, _ = columns(order, order, order, int(frame.width * 4))
    shown = np.clip(np.nan_to_num(peaks, nan=low), low, None)
    panel.fill_between(places, low, shown, color=LIGHT["bar"], alpha=0.16, linewidth=0)
    panel.plot(places, shown, color=LIGHT["bar"], lw=1.0)
    panel.xaxis.set_major_locator(MaxNLocator(int(frame.pick(16, 8)), integer=True, steps=[1, 2, 5, 10]))
    panel.set_xlim(float(order.min()), float(order.max()))
    title(panel, "Amplitude", "arcsec")
    foot(panel, "Order, cycles per turn of the wave generator")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    order, amplitude = axis(curves, "spectrum.order"), line(curves, "spectrum.amplitude")
    if order is None or amplitude is None:
        return ""
    top = int(np.nanargmax(amplitude))
    return (
        f"Fine order spectrum from order {plain(order[0], 3)} to {plain(order[-1], 3)} on a logarithmic scale; "
        f"highest at order {plain(order[top], 4)} with {plain(amplitude[top], 3)} arcsec."
    )


DRAWING = Drawing(
    "spectrum",
    "Fine order spectrum",
    "The error of all revolutions in one piece. Lines at whole orders repeat with every turn of the wave "
    "generator; lines beside them belong to the flexspline, to the output or to time. The longer the run, the "
    "closer two orders may lie and still be told apart.",
    draw,
    say,
)
