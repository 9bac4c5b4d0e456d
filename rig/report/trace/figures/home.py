"""How much of the excess each coordinate predicts, alone or with another, in rows it was not fitted to."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter

from rig.report.figures.arrays import line
from rig.report.figures.canvas import PX, Array, Curves, Drawing, Frame, panel_at
from rig.report.numbers import plain
from rig.report.palette import LIGHT
from rig.report.trace.channels import CHANNELS, Channel

ROWS = (
    "motor angle",
    "load angle",
    "direction",
    "torque",
    "torque, rising or falling",
    "speed",
    "time",
    "motor angle and direction",
    "motor angle and torque",
    "motor angle and speed",
    "speed and direction",
)
FAINT = 0.1  # share of a fixed frequency below which it is not worth a line
TELLING = 0.5  # share from which a coordinate is said to be where the residual lives
RIVAL = 0.6  # of the best share from which the next coordinate is said as well
STEP, LEFT, HEAD, FOOT, GAP = 21.0, 158.0, 30.0, 16.0, 46.0


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses share.<C> (11,) and share_frequency_hz.<C> (2,). None when no channel has an excess."""
    shown = [(c, rows) for c in CHANNELS if (rows := _rows(curves, c)) is not None]
    if not shown:
        return None
    names = list(dict.fromkeys(name for _, rows in shown for name, _ in rows))
    across = len(shown) if not frame.narrow else 1
    deep = -(-len(shown) // across)
    height = STEP * len(names)
    figure = Figure(figsize=(frame.width * PX, deep * (HEAD + height + FOOT) * PX), dpi=72)
    figure.patch.set_visible(False)
    width = (frame.width - LEFT - 40 - GAP * (across - 1)) / across
    for i, (channel, rows) in enumerate(shown):
        column, row = i % across, i // across
        box = (LEFT + column * (width + GAP), HEAD + row * (HEAD + height + FOOT), width, height)
        panel = panel_at(figure, frame, box)
        panel.grid(visible=False)
        values = dict(rows)
        at = np.arange(len(names))[::-1]
        sizes = np.array([values.get(name, np.nan) for name in names])
        top = np.nanmax(sizes)
        colours = [LIGHT["bar"] if v >= 0.7 * top and v > 0.3 else LIGHT["bar-soft"] for v in sizes]
        panel.barh(at, np.nan_to_num(sizes), height=0.62, color=colours)
        for y, v in zip(at, sizes, strict=True):
            text = f"{100 * v:.0f} %" if np.isfinite(v) else "–"
            panel.text(np.nan_to_num(v) + 0.02, y, text, va="center", fontsize=11, color=LIGHT["muted"])
        panel.set_xlim(0, 1)
        panel.set_ylim(-0.6, len(names) - 0.4)
        panel.xaxis.set_major_locator(FixedLocator([]))
        panel.yaxis.set_major_locator(FixedLocator(list(at)))
        panel.yaxis.set_major_formatter(FuncFormatter(lambda y, _: names[len(names) - 1 - round(y)]))
        panel.tick_params(axis="y", labelleft=column == 0, labelcolor=LIGHT["ink"])
        panel.axvline(0, color=LIGHT["axis"], lw=1)
        left = 2 - LEFT if frame.narrow else 0
        panel.annotate(
            f"{channel.name} {channel.short}", (0, 1), (left, 8), "axes fraction", "offset points", fontweight="bold"
        )
    return figure


def _rows(curves: Curves, channel: Channel) -> list[tuple[str, float]] | None:
    shares = line(curves, f"share.{channel.letter}", len(ROWS))
    if shares is None:
        return None
    line_hz: Array | None = line(curves, f"share_frequency_hz.{channel.letter}", 2)
    rows = list(zip(ROWS, map(float, np.minimum(shares, 1.0)), strict=True))  # noise can foretell more than all
    return (
        rows
        if line_hz is None or line_hz[1] < FAINT
        else [*rows, (f"fixed frequency, {plain(line_hz[0], 3)} Hz", min(float(line_hz[1]), 1.0))]
    )


def told(curves: Curves) -> list[str]:
    """One sentence for each channel with an excess: what predicts most of it, or that nothing does."""
    out = []
    for channel in CHANNELS:
        rows = [r for r in _rows(curves, channel) or [] if np.isfinite(r[1])]
        if not rows:
            continue
        (name, share), (other, less), *_ = sorted(rows, key=lambda r: -r[1])
        if share < TELLING:
            verb = "come" if " and " in name else "comes"
            near = f"; {name} {verb} closest, {share:.0%}" if share >= FAINT else ""
            out.append(f"{channel.name}: no coordinate predicts half of the excess{near}.")
        else:
            also = f"; {other}: {less:.0%}" if less >= RIVAL * share else ""
            verb = "predict" if " and " in name else "predicts"
            out.append(f"{channel.name}: {name} {verb} {share:.0%} of the excess over the floor{also}.")
    return [text.replace("%", "\u00a0%") for text in out]


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for channel in CHANNELS:
        rows = [r for r in _rows(curves, channel) or [] if np.isfinite(r[1])]
        if rows:
            best = sorted(rows, key=lambda r: -r[1])[:3]
            said.append(f"{channel.name}: " + ", ".join(f"{name} {100 * v:.0f} %" for name, v in best))
    return "Share of the excess over the floor that a coordinate predicts. " + "; ".join(said) + "."


DRAWING = Drawing(
    "home",
    "What predicts it",
    "Share of the excess over the floor (the baseline’s, on held-out runs) that a coordinate, or two together, "
    "predict in rows the prediction was not made from: by the mean over bins or, of the motor angle, by 15 orders and"
    " of the load angle by 8, each run with an offset of its own. A pair that predicts much where neither does alone "
    "says that one changes the size of the other’s effect. Channels at their floor are left out; for the shaft torque"
    " its own reading cannot stand as a coordinate.",
    draw,
    say,
)
