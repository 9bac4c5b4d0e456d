"""Order spectrum: amplitude of each order of the wave generator with its 95 % interval."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter

from rig.report.figures.arrays import line
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, key, log_axis, sheet, title
from rig.report.numbers import fixed, places, plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses orders.order, orders.amplitude, orders.ci95 (half width) (k,), arcsec. None without a positive amplitude."""
    order = line(curves, "orders.order")
    amplitude = None if order is None else line(curves, "orders.amplitude", len(order))
    if order is None or amplitude is None or not (amplitude > 0).any():
        return None
    half = line(curves, "orders.ci95", len(order))
    half = np.zeros_like(order) if half is None else np.nan_to_num(np.abs(half))
    known = amplitude > half  # else nothing tells it from zero
    positive = amplitude[amplitude > 0]
    low = 10.0 ** np.floor(np.log10(positive.min() / 1.5))
    high = float(np.nanmax(amplitude + half)) * 1.9
    figure, (panel,) = sheet(frame, [frame.pick(250, 220)], keys=int(frame.narrow))
    log_axis(panel, low, high)
    even = np.isclose(order % 2, 0)
    for chosen, style in (
        (known & even, {"color": LIGHT["bar"]}),
        (known & ~even, {"color": LIGHT["bar-soft"]}),
        (~known, {"facecolor": "none", "edgecolor": LIGHT["axis"], "linestyle": (0, (2, 2))}),
    ):
        if chosen.any():
            panel.bar(order[chosen], np.fmax(amplitude[chosen], low) - low, 0.66, bottom=low, zorder=2, **style)
    if half.any():
        ends = np.clip(amplitude - half, low, None), amplitude + half
        panel.vlines(order, *ends, color=LIGHT["ink"], lw=1.3, zorder=3)
        for end in ends:
            panel.hlines(
                end[end > low], order[end > low] - 0.13, order[end > low] + 0.13, color=LIGHT["ink"], lw=1.3, zorder=3
            )
    if not frame.narrow:
        for n, c, h in zip(order, amplitude, half, strict=True):
            if np.isfinite(c):
                text = (
                    fixed(c, places(h) - 1) if h > 0 else plain(c, 3)
                )  # one digit of the uncertainty: bars are crowded
                panel.annotate(text, (n, c + h), (0, 5), textcoords="offset points", ha="center", fontsize=10.5)
    title(panel, "Amplitude", "arcsec", keys=int(frame.narrow))
    names = [("bar", "even orders"), ("bar-soft", "odd orders")]
    handles = [
        Patch(color=LIGHT[c], label=n)
        for (c, n), any_ in zip(names, (even, ~even), strict=True)
        if (known & any_).any()
    ]
    if (~known).any():
        handles.append(Patch(facecolor="none", edgecolor=LIGHT["axis"], ls=(0, (2, 2)), label="not told from zero"))
    key(panel, handles, columns=3 * frame.narrow)
    panel.set_xlim(order.min() - 0.6, order.max() + 0.6)
    panel.xaxis.set_major_locator(FixedLocator(list(order[:: max(1, int(np.ceil(len(order) / frame.pick(25, 15))))])))
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    foot(panel, "Order, cycles per turn of the wave generator")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    order, amplitude = line(curves, "orders.order"), line(curves, "orders.amplitude")
    if order is None or amplitude is None:
        return ""
    first = np.argsort(-np.nan_to_num(amplitude))[:3]
    largest = ", ".join(f"order {order[i]:g} with {plain(amplitude[i], 3)} arcsec" for i in first)
    return f"Amplitude of {len(order)} orders of the wave generator on a logarithmic scale; the largest are {largest}."


DRAWING = Drawing(
    "orders",
    "Orders of the wave generator",
    "Order n repeats n times per turn of the wave generator. Order 2 comes from its two lobes, order 1 from "
    "eccentricity of a shaft or of an encoder. Whiskers are 95 % intervals from the scatter of single "
    "revolutions. The scale is logarithmic: read the number, not the length of the bar.",
    draw,
    say,
)
