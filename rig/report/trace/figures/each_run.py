"""Error of every held-out run before and after, beside its floor: one line a run, one panel a channel."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator

from rig.report.figures.canvas import PX, Array, Curves, Drawing, Frame, decade, key, panel_at
from rig.report.numbers import plain
from rig.report.palette import LIGHT
from rig.report.trace.channels import CHANNELS
from rig.report.trace.figures.style import AFTER, BEFORE, FLOOR, LETTER, handle, labels

STEP, HEAD, FOOT, GAP = 22.0, 52.0, 40.0, 26.0
PREFIX = "each_run."


def names(curves: Curves) -> list[str]:
    """Held-out runs, in the order given."""
    return [k.removeprefix(PREFIX) for k in curves if k.startswith(PREFIX)]


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses each_run.<run> (9,): before, after, floor of θ̃ in arcsec, of τ_m and τ_l in N·m; NaN where not measured."""
    runs = names(curves)
    table = np.array([np.asarray(curves[PREFIX + n], dtype=np.float64) for n in runs]).reshape(-1, 3, 3)
    shown = [(i, c) for i, c in enumerate(CHANNELS) if table.size and np.isfinite(table[:, i, :2]).any()]
    if not runs or not shown:
        return None
    called = labels(runs, int((frame.pick(190, 132) - 12) / LETTER))
    left = min(frame.pick(190, 132), 12 + 7.2 * max(map(len, called)))
    across = 1 if frame.narrow else len(shown)
    deep = -(-len(shown) // across)
    height = STEP * len(runs)
    figure = Figure(figsize=(frame.width * PX, deep * (HEAD + height + FOOT) * PX), dpi=72)
    figure.patch.set_visible(False)
    width = (frame.width - left - 14 - GAP * (across - 1)) / across
    for k, (i, channel) in enumerate(shown):
        column, row = k % across, k // across
        box = (left + column * (width + GAP), HEAD + row * (HEAD + height + FOOT), width, height)
        panel = panel_at(figure, frame, box)
        _bars(panel, table[:, i])
        panel.yaxis.set_major_locator(FixedLocator(list(range(len(runs)))))
        panel.yaxis.set_major_formatter(FuncFormatter(lambda y, _: called[len(called) - 1 - round(y)]))
        panel.tick_params(axis="y", labelleft=column == 0, labelcolor=LIGHT["ink"], labelsize=11)
        at = (2 - left if column == 0 else 0, 30 if k == 0 else 10)
        panel.annotate(
            f"{channel.name}, {channel.unit}", (0, 1), at, "axes fraction", "offset points", fontweight="bold"
        )
        if k == 0:
            handles = [handle({**BEFORE, "marker": "o", "ls": "none"}, "before")]
            handles += [handle({**AFTER, "marker": "s", "ls": "none"}, "after")]
            handles += [handle({**FLOOR, "marker": "|", "ms": 11, "mew": 2, "ls": "none"}, "floor")]
            key(panel, handles, columns=3)
            legend = panel.get_legend()
            if legend is not None:
                legend.set_bbox_to_anchor((-left / width, 1.0), transform=panel.transAxes)
    return figure


def _bars(panel: Axes, values: Array) -> None:
    before, after, floor = values.T
    at = np.arange(len(values))[::-1]
    positive = values[np.isfinite(values) & (values > 0)]
    panel.set_xscale("log")
    panel.grid(axis="y", visible=False)
    panel.grid(axis="x", color=LIGHT["grid"], linewidth=1.0)
    panel.hlines(at, np.fmin(before, after), np.fmax(before, after), color=LIGHT["grid"], lw=5)
    panel.plot(floor, at, ls="none", marker="|", ms=13, mew=2, color=LIGHT["level"])
    panel.plot(before, at, ls="none", marker="o", ms=6.5, color=BEFORE["color"])
    panel.plot(after, at, ls="none", marker="s", ms=5.5, color=AFTER["color"])
    panel.set_xlim(float(positive.min()) / 1.6, float(positive.max()) * 1.6)
    panel.set_ylim(-0.6, len(values) - 0.4)
    wide = np.log10(positive.max() / positive.min())
    panel.xaxis.set_major_locator(LogLocator(subs=(1.0,) if wide > 1.5 else (1.0, 2.0, 5.0), numticks=6))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: plain(x, 2) if x < 1 else decade(x)))


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for name in names(curves):
        values = np.asarray(curves[PREFIX + name], dtype=np.float64).reshape(3, 3)
        for (before, after, floor), channel in zip(values, CHANNELS, strict=True):
            if np.isfinite(before) and channel.letter == "A":
                said.append(f"{name} {plain(before, 3)} to {plain(after, 3)} arcsec, floor {plain(floor, 2)}")
    return "Error of each held-out run before and after. Kinematic error: " + "; ".join(said) + "."


DRAWING = Drawing(
    "each-run",
    "Every held-out run, before and after",
    "RMS error of the model on runs that no coefficient and no floor comes from, and that could only take names away; "
    "logarithmic. The bar marks the floor: what two runs of the same condition differ by, divided by √2. An error at "
    "its floor has nothing left to explain. The same numbers stand in the table below.",
    draw,
    say,
)
