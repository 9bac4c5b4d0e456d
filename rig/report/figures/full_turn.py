"""θ̃ over one turn of the output, with the span that makers call transmission accuracy; and the lines close together."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, MultipleLocator

from rig.report.figures.arrays import axis, columns, line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, log_axis, sheet, title
from rig.report.numbers import estimate, plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses turn.theta_l_deg, turn.error (B,), deg and arcsec; turn.accuracy (3,), value and ends of its interval."""
    theta = axis(curves, "turn.theta_l_deg")
    error = None if theta is None else line(curves, "turn.error", len(theta))
    if theta is None or error is None:
        return None
    figure, (panel,) = sheet(frame, [frame.pick(250, 210)], right=frame.pick(110, 14))
    middle, least, greatest = columns(theta, error, error, int(frame.width))
    panel.fill_between(middle, least, greatest, color=LIGHT["bar"], alpha=0.3, linewidth=0)
    panel.plot(middle, 0.5 * (least + greatest), color=LIGHT["bar"], lw=0.8)
    _span(panel, frame, error, line(curves, "turn.accuracy", 3))
    panel.set_xlim(0, 360)
    panel.xaxis.set_major_locator(MultipleLocator(frame.pick(45, 90)))
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}°"))
    title(panel, "Error over the turn", "arcsec")
    foot(panel, "Output angle from the start of the turn")
    return figure


def _span(panel: Axes, frame: Frame, error: Array, accuracy: Array | None) -> None:
    """Lines at the greatest and the least, and what lies between."""
    low, high = float(np.nanmin(error)), float(np.nanmax(error))
    for level in (low, high):
        panel.axhline(level, color=LIGHT["level"], lw=1.2, ls=(0, (5, 3)))
    if frame.narrow:
        return
    ends = {"arrowstyle": "<->", "color": LIGHT["ink"], "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    at = panel.get_yaxis_transform()
    panel.annotate("", (1.02, low), (1.02, high), at, arrowprops=ends, annotation_clip=False)
    text = plain(high - low, 4)
    if accuracy is not None:
        text = estimate(float(accuracy[0]), (float(accuracy[1]), float(accuracy[2])))
    panel.annotate(
        f"{text}\narcsec", (1.02, 0.5 * (low + high)), (6, 0), at, textcoords="offset points", va="center", fontsize=11
    )


def say(curves: Curves) -> str:
    """The figure in words."""
    error = line(curves, "turn.error")
    if error is None:
        return ""
    span = plain(float(np.nanmax(error) - np.nanmin(error)), 3)
    return f"Kinematic error over one whole turn of the output in one direction; it spans {span} arcsec."


def draw_lines(curves: Curves, frame: Frame) -> Figure | None:
    """Uses turn.order, turn.amplitude, turn.low, turn.high (m,), arcsec."""
    order = line(curves, "turn.order")
    if order is None or np.isnan(order).any():
        return None
    parts = [line(curves, f"turn.{name}", len(order)) for name in ("amplitude", "low", "high")]
    amplitude, low, high = parts
    if amplitude is None or low is None or high is None or not (high > 0).any():
        return None
    top = float(np.nanmax(high))
    floor = max(float(np.nanmin(high[high > 0])) / 3.0, top / 1e6)
    figure, (panel,) = sheet(frame, [frame.pick(210, 190)])
    log_axis(panel, floor, top * 2.5)
    place = np.arange(len(order), dtype=np.float64)
    known = low > 0
    panel.vlines(place, floor, np.fmax(np.where(known, amplitude, floor), floor), color=LIGHT["bar-soft"], lw=7)
    panel.vlines(place, np.fmax(low, floor), np.fmax(high, floor), color=LIGHT["ink"], lw=1.4)
    for x, value, sure, end in zip(place, amplitude, known, high, strict=True):
        text = plain(float(value), 3) if sure else f"< {plain(float(end), 2)}"
        panel.annotate(text, (x, max(end, floor)), (0, 5), textcoords="offset points", ha="center", fontsize=10.5)
    panel.set_xlim(-0.6, len(order) - 0.4)
    panel.xaxis.set_major_locator(FixedLocator(list(place)))
    names = [f"{n:g}" for n in order]
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: names[round(x)] if 0 <= round(x) < len(names) else ""))
    title(panel, "Amplitude", "arcsec")
    foot(panel, "Order, cycles per turn of the wave generator")
    return figure


def say_lines(curves: Curves) -> str:
    """The figure in words."""
    order, amplitude = line(curves, "turn.order"), line(curves, "turn.amplitude")
    if order is None or amplitude is None:
        return ""
    said = ", ".join(f"order {n:g} {plain(c, 3)} arcsec" for n, c in zip(order, amplitude, strict=False))
    return f"Amplitudes of lines that only a whole turn of the output tells apart: {said}."


DRAWING = Drawing(
    "full-turn",
    "One turn of the output",
    "Between the dashed lines lies the greatest less the least of the recorded curve. Makers call it transmission "
    "accuracy: over one turn of the output, in one direction. It is not the paper's peak to peak, which is of the mean "
    "turn of the wave generator and knows nothing of what changes along the output.",
    draw,
    say,
)
LINES = Drawing(
    "full-turn-lines",
    "Lines told apart by a whole turn",
    "Orders below 1 repeat with the output. An error of the turning toothed part is met a little more (or less) often "
    "than once a turn of the wave generator: 2.04 beside 2. Both together make the basic waveform breathe twice a turn "
    "of the output. Whiskers are 95 % intervals; a value with < is an upper limit.",
    draw_lines,
    say_lines,
)
