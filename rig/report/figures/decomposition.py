"""θ̃ at speed, the pure kinematic error, and their difference: what flexibility adds, by angle and by order."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, angle_axis, foot, key, log_axis, sheet, title
from rig.report.figures.kinematic_error import closed
from rig.report.numbers import plain
from rig.report.palette import LIGHT

PARTS = (
    ("total", "θ̃ at speed", {"color": LIGHT["forward"], "lw": 1.8}),
    ("pure", "θ̃_p, slow run", {"color": LIGHT["muted"], "lw": 1.6, "ls": (0, (5, 2))}),
    ("flexible", "θ̃_s, their difference", {"color": LIGHT["reverse"], "lw": 1.8, "ls": (0, (7, 2.2))}),
)


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses decomposition.theta_deg, .total, .pure, .flexible (G,), arcsec. None without all of them."""
    theta = axis(curves, "decomposition.theta_deg")
    if theta is None:
        return None
    parts = [(line(curves, f"decomposition.{name}", len(theta)), word, style) for name, word, style in PARTS]
    if any(values is None for values, _, _ in parts):
        return None
    columns = int(frame.pick(3, 1))
    keys = -(-len(parts) // columns)
    figure, (panel,) = sheet(frame, [frame.pick(260, 220)], keys=keys)
    panel.axhline(0, color=LIGHT["axis"], lw=1)
    handles = [h for v, w, style in parts if v is not None for h in panel.plot(*closed(theta, v), label=w, **style)]
    title(panel, "Kinematic error", "arcsec", keys=keys)
    key(panel, handles, columns)
    angle_axis([panel], frame)
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for name, words, _ in PARTS:
        values = line(curves, f"decomposition.{name}")
        if values is not None:
            said.append(f"{words}: peak to peak {plain(float(np.nanmax(values) - np.nanmin(values)), 3)} arcsec")
    return "θ̃ at speed split into the pure kinematic error and what flexibility adds. " + "; ".join(said) + "."


def draw_orders(curves: Curves, frame: Frame) -> Figure | None:
    """Uses decomposition.order, .measured, .low, .high (k,), arcsec; .predicted (k,) where theory could be had."""
    order = axis(curves, "decomposition.order")
    if order is None:
        return None
    found = {name: line(curves, f"decomposition.{name}", len(order)) for name in ("measured", "low", "high")}
    measured, low, high = found["measured"], found["low"], found["high"]
    if measured is None or low is None or high is None or not (high > 0).any():
        return None
    predicted = line(curves, "decomposition.predicted", len(order))
    top = float(np.nanmax(high))
    floor = max(float(np.nanmin(high[high > 0])) / 3.0, top / 1e5)
    figure, (panel,) = sheet(frame, [frame.pick(230, 200)], keys=int(frame.narrow))
    log_axis(panel, floor, top * 1.8)
    handles = [_measured(panel, order, measured, low, high, floor)]
    if predicted is not None:
        shown = np.where(predicted > floor, predicted, np.nan)
        style = {"mfc": "none", "mec": LIGHT["fit"], "mew": 1.5, "ms": 9.0}
        handles += panel.plot(order, shown, ls="none", marker="D", label="linear theory", **style)
    title(panel, "Amplitude of θ̃_s", "arcsec", keys=int(frame.narrow))
    key(panel, handles, columns=2 * frame.narrow)
    panel.set_xlim(float(order.min()) - 0.6, float(order.max()) + 0.6)
    every = max(1, int(np.ceil(len(order) / frame.pick(25, 15))))
    panel.xaxis.set_major_locator(FixedLocator(list(order[::every])))
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    foot(panel, "Order, cycles per turn of the wave generator")
    return figure


def _measured(panel: Axes, order: Array, measured: Array, low: Array, high: Array, floor: float) -> object:
    """Dots with their 95 % intervals; one that reaches zero is an upper limit, drawn down to the floor."""
    panel.vlines(order, np.fmax(low, floor), np.fmax(high, floor), color=LIGHT["reverse"], lw=1.6)
    shown = np.where((measured > floor) & (low > 0), measured, np.nan)
    (dots,) = panel.plot(order, shown, ls="none", marker="o", ms=6, color=LIGHT["reverse"], label="measured, 95 %")
    return dots


def say_orders(curves: Curves) -> str:
    """The figure in words."""
    order, measured = axis(curves, "decomposition.order"), line(curves, "decomposition.measured")
    if order is None or measured is None:
        return ""
    top = int(np.nanargmax(measured))
    predicted = line(curves, "decomposition.predicted", len(order))
    largest = f"order {order[top]:g} with {plain(measured[top], 3)} arcsec"
    text = f"Amplitude of the flexible part by order; largest at {largest}"
    return text + ("." if predicted is None else f", linear theory says {plain(predicted[top], 3)} arcsec.")


DRAWING = Drawing(
    "decomposition",
    "What flexibility adds at speed",
    "θ̃ at speed less the pure kinematic error of a slow run, angle on angle, is what the gear's spring adds. Each "
    "curve is the fitted series of its run, means and trends taken out.",
    draw,
    say,
)
ORDERS = Drawing(
    "decomposition-orders",
    "Flexible part by order, beside linear theory",
    "Linear theory: the pure error times r²/(1 − r² + 2jζr), r the order times the speed over the natural frequency, "
    "with the declared inertias, stiffness and damping, at the speeds of the single turns. Near r = 1 the answer "
    "hangs on the damping and on how far the speed wandered. Lines down to the axis are upper limits.",
    draw_orders,
    say_orders,
)
