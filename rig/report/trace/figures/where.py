"""Where the residual lives: RMS over the floor, before and after, against each coordinate; small multiples."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator

from rig.report.figures.arrays import line
from rig.report.figures.canvas import PX, Array, Curves, Drawing, Frame, foot, key, log_axis, panel_at
from rig.report.numbers import plain
from rig.report.palette import LIGHT
from rig.report.trace.channels import CHANNELS, Channel
from rig.report.trace.figures.style import AFTER, BEFORE, FLOOR, handle

RATIOS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
DECADES = (-100.0, -10.0, 0.0, 10.0, 100.0, 1000.0)
FINER = tuple(sign * m * 10.0**d for d in (-1, 0, 1, 2, 3) for m in (1, 2, 5) for sign in (-1, 1))
FEWEST = 2  # ticks from which a scale can be read
APART = 0.22  # of a panel's width between two ticks: their numbers are as wide
MUTED: dict[str, Any] = {"color": LIGHT["muted"], "fontsize": 10}
HEAD, BETWEEN, FOOT, LEFT, GAP = 50.0, 34.0, 44.0, 46.0, 12.0


class Coordinate(NamedTuple):
    """One column of the figure."""

    key: str
    name: str
    ticks: tuple[float, ...] | None = None
    knee: float | None = None  # even up to it, logarithmic beyond


COORDINATES = (
    Coordinate("motor_angle", "Motor angle, °", (0, 90, 180, 270)),
    Coordinate("load_angle", "Load angle, °", (0, 90, 180, 270)),
    Coordinate("direction", "Direction", (-1, 1)),
    Coordinate("load", "Torque, N·m", None, 1.0),
    Coordinate("speed", "Speed, rpm", None, 1.0),
    Coordinate("time", "Time, min"),
)


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses where.<C>.<coordinate>.x, .before, .after. None when no channel has any."""
    shown = [c for c in CHANNELS if any(_found(curves, c, q.key) is not None for q in COORDINATES)]
    if not shown:
        return None
    across = int(frame.pick(6, 3))
    lines = [(c, COORDINATES[i : i + across]) for c in shown for i in range(0, 6, across)]
    height = frame.pick(104, 84)
    total = HEAD + len(lines) * (height + BETWEEN + FOOT) - BETWEEN
    figure = Figure(figsize=(frame.width * PX, total * PX), dpi=72)
    figure.patch.set_visible(False)
    width = (frame.width - LEFT - 12 - GAP * (across - 1)) / across
    if frame.mark:  # once across all of them: a panel is too small for it
        panel_at(figure, frame, (LEFT, HEAD, frame.width - LEFT, total - HEAD - FOOT)).set_axis_off()
    first = None
    for row, (channel, coordinates) in enumerate(lines):
        top = HEAD + row * (height + BETWEEN + FOOT)
        low, high = _limits(curves, channel)
        for column, q in enumerate(coordinates):
            panel = panel_at(figure, Frame(frame.width), (LEFT + column * (width + GAP), top, width, height))
            log_axis(panel, low, high)
            panel.yaxis.set_major_locator(FixedLocator([v for v in RATIOS if low <= v <= high]))
            _panel(panel, curves, channel, q)
            panel.tick_params(axis="y", labelleft=column == 0)
            first = first or panel
            if column == 0:
                _name(panel, f"{channel.name} {channel.short}, RMS over floor")
    if first is not None:
        _key(first)
    return figure


def _key(panel: Axes) -> None:
    handles = [handle(BEFORE, "before"), handle(AFTER, "after"), handle(FLOOR, "floor")]
    key(panel, handles, columns=3)
    legend = panel.get_legend()
    if legend is not None:
        legend.set_bbox_to_anchor((-0.02, 1.22), transform=panel.transAxes)


def _name(panel: Axes, text: str) -> None:
    panel.annotate(text, (0, 1), (2 - LEFT, 8), "axes fraction", "offset points", fontweight="bold")


def _found(curves: Curves, channel: Channel, name: str) -> tuple[Array, Array, Array] | None:
    stem = f"where.{channel.letter}.{name}"
    x = line(curves, f"{stem}.x")
    before = None if x is None else line(curves, f"{stem}.before", len(x))
    after = None if x is None else line(curves, f"{stem}.after", len(x))
    return None if x is None or before is None or after is None else (x, before, after)


def _limits(curves: Curves, channel: Channel) -> tuple[float, float]:
    found = [f for q in COORDINATES if (f := _found(curves, channel, q.key)) is not None]
    values = np.concatenate([np.concatenate(f[1:]) for f in found])
    values = values[np.isfinite(values) & (values > 0)]
    low, high = (float(values.min()), float(values.max())) if values.size else (1.0, 1.0)
    return max(0.1, min(0.5, low / 1.2)), max(2.5, high * 1.4)


def _panel(panel: Axes, curves: Curves, channel: Channel, q: Coordinate) -> None:
    panel.axhline(1.0, **FLOOR)
    found = _found(curves, channel, q.key)
    if found is not None:
        x, before, after = found
        x = x / 60 if q.key == "time" else x
        if q.knee is not None:
            panel.set_xscale("asinh", linear_width=q.knee)
        for values, style, marker in ((before, BEFORE, "o"), (after, AFTER, "s")):
            there = np.isfinite(values)
            panel.plot(x[there], values[there], marker=marker, ms=2.6, **{**style, "lw": 1.1})
    else:
        panel.text(0.5, 0.25, "one value held out", transform=panel.transAxes, ha="center", **MUTED)
    _ticks(panel, q)
    foot(panel, q.name)
    panel.margins(x=0.08)


def _ticks(panel: Axes, q: Coordinate) -> None:
    if q.knee is not None:
        low, high = panel.get_xlim()
        panel.xaxis.set_major_locator(FixedLocator(_beyond_the_knee(low, high, q.knee)))
        panel.xaxis.set_minor_locator(NullLocator())
    elif q.ticks is not None:
        panel.xaxis.set_major_locator(FixedLocator(list(q.ticks)))
        panel.set_xlim((-2, 2) if q.key == "direction" else (0, 360))
    else:
        panel.xaxis.set_major_locator(MaxNLocator(3, integer=True))
    names = {-1.0: "−", 1.0: "+"} if q.key == "direction" else {}
    panel.xaxis.set_major_formatter(FuncFormatter(lambda v, _: names.get(v, plain(v, 3))))
    panel.tick_params(axis="x", labelsize=10.5, color=LIGHT["axis"])


def _beyond_the_knee(low: float, high: float, knee: float) -> list[float]:
    """Decades, or 1, 2, 5 where fewer than two of those are in sight; zero and the largest first, none so near another
    that their numbers overlap."""
    decades, finer = ([v for v in steps if low <= v <= high] for steps in (DECADES, (0.0, *FINER)))
    whole = float(np.arcsinh(high / knee) - np.arcsinh(low / knee))
    kept: list[float] = []
    for v in sorted(decades if len(decades) >= FEWEST else finer, key=lambda v: (v != 0, -abs(v))):
        if all(abs(np.arcsinh(v / knee) - np.arcsinh(k / knee)) >= APART * whole for k in kept):
            kept.append(v)
    return sorted(kept)


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for channel in CHANNELS:
        for q in COORDINATES:
            found = _found(curves, channel, q.key)
            if found is not None:
                low, high = np.nanmin(found[1]), np.nanmax(found[1])
                said.append(
                    f"{channel.name} against {q.name.split(',')[0].lower()}: {plain(low, 2)} to {plain(high, 2)} "
                    "times the floor before, "
                    f"{plain(np.nanmin(found[2]), 2)} to {plain(np.nanmax(found[2]), 2)} after"
                )
    return "; ".join(said) + "."


DRAWING = Drawing(
    "where",
    "Where the residual lives",
    "RMS of what the model leaves on held-out runs, over the floor, in bins of one coordinate at a time, on a "
    "logarithmic scale. A flat line at 1 means that nothing is left to explain. Torque is that through the gear; "
    "torque and speed axes are even up to 1 and logarithmic beyond. Bins with fewer than 30 samples are left out.",
    draw,
    say,
)
