"""Order spectrum: amplitude of each order of the wave generator with its 95 % interval."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, log_axis, sheet, title
from rig.report.numbers import fixed, places, plain
from rig.report.palette import LIGHT

Bool = npt.NDArray[np.bool_]


def interval(curves: Curves, amplitude: Array) -> tuple[Array, Array]:
    """Ends of the 95 % interval of each amplitude, (k,): orders.low and orders.high, else orders.ci95 either side.

    An interval that reaches zero does not tell its order from zero; without any, the ends are the amplitude itself.
    """
    low, high = line(curves, "orders.low", len(amplitude)), line(curves, "orders.high", len(amplitude))
    half = line(curves, "orders.ci95", len(amplitude))
    if low is None or high is None:
        half = np.zeros_like(amplitude) if half is None else np.nan_to_num(np.abs(half))
        low, high = amplitude - half, amplitude + half
    return np.fmax(np.where(np.isfinite(low), low, amplitude), 0.0), np.where(np.isfinite(high), high, amplitude)


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses orders.order, orders.amplitude, orders.ci95 (half width) or orders.low and orders.high (k,), arcsec. None
    without a positive amplitude.
    """
    order = axis(curves, "orders.order")
    amplitude = None if order is None else line(curves, "orders.amplitude", len(order))
    if order is None or amplitude is None or not (amplitude > 0).any():
        return None
    least, greatest = interval(curves, amplitude)
    known = (amplitude > 0) & (least > 0)
    shown = np.where(known, amplitude, greatest)  # of an order that may be zero, how large it is at most
    floor = float(10.0 ** np.floor(np.log10(np.nanmin(shown[shown > 0]) / 1.5)))
    lines = int(frame.pick(0, 1 if known.all() else 2))
    figure, (panel,) = sheet(frame, [frame.pick(250, 220)], keys=lines)
    log_axis(panel, floor, float(np.nanmax(greatest)) * 1.9)
    handles = _bars(panel, order, shown, known, floor)
    if (greatest > least).any():
        _whiskers(panel, order[known], np.fmax(least, floor)[known], greatest[known], floor)
    if not frame.narrow:
        _numbers(panel, order, shown, known, np.stack((least, greatest)))
    title(panel, "Amplitude", "arcsec", keys=lines)
    key(panel, handles, columns=2 * frame.narrow)
    panel.set_xlim(float(order.min()) - 0.6, float(order.max()) + 0.6)
    every = max(1, int(np.ceil(len(order) / frame.pick(25, 15))))
    panel.xaxis.set_major_locator(FixedLocator(list(order[::every])))
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    foot(panel, "Order, cycles per turn of the wave generator")
    return figure


def _bars(panel: Axes, order: Array, amplitude: Array, known: Bool, floor: float) -> list[Patch]:
    """Bars from `floor` up, dashed outlines up to the upper limit of orders not told from zero; gives the key."""
    even = np.isclose(order % 2, 0)
    outline: dict[str, Any] = {"facecolor": "none", "edgecolor": LIGHT["axis"], "linestyle": (0, (2, 2))}
    handles = []
    for label, chosen, style in (
        ("even orders", known & even, {"color": LIGHT["bar"]}),
        ("odd orders", known & ~even, {"color": LIGHT["bar-soft"]}),
        ("upper limit, not told from zero", ~known, outline),
    ):
        if chosen.any():
            heights = np.fmax(amplitude[chosen], floor) - floor
            panel.bar(order[chosen], heights, 0.66, bottom=floor, zorder=2, **style)
            handles.append(Patch(label=label, **style))
    return handles


def _whiskers(panel: Axes, order: Array, least: Array, greatest: Array, floor: float) -> None:
    panel.vlines(order, least, greatest, color=LIGHT["ink"], lw=1.3, zorder=3)
    for end in (least, greatest):
        at, level = order[end > floor], end[end > floor]  # an interval that reaches the floor has no end there
        panel.hlines(level, at - 0.13, at + 0.13, color=LIGHT["ink"], lw=1.3, zorder=3)


def _numbers(panel: Axes, order: Array, shown: Array, known: Bool, ends: Array) -> None:
    """The number above each bar, to one digit of its uncertainty: bars are crowded. `ends`: (2, k)."""
    for n, c, sure, low, high in zip(order, shown, known, *ends, strict=True):
        if np.isfinite(c):
            text = plain(c, 2) if not sure else fixed(c, places((high - low) / 2) - 1) if high > low else plain(c, 3)
            place = (n, high if sure else c)
            words = text if sure else f"< {text}"
            panel.annotate(words, place, (0, 5), textcoords="offset points", ha="center", fontsize=10.5)


def say(curves: Curves) -> str:
    """The figure in words."""
    order, amplitude = axis(curves, "orders.order"), line(curves, "orders.amplitude")
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
