"""The sheet every figure is drawn on: sizes in CSS pixels, fixed margins, one look. Kept free of pyplot, which costs
start-up and global state.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, MultipleLocator, NullLocator

from rig.report.figures.ticks import Panel
from rig.report.numbers import SUPERSCRIPT
from rig.report.palette import LIGHT

Array = npt.NDArray[np.float64]
Curves = Mapping[str, Array]

PX = 1 / 72  # inch; SVG user units are points, which a page takes as pixels
LEFT, HEAD, KEY, BETWEEN, FOOT = 52.0, 28.0, 19.0, 12.0, 40.0
NAME_BELOW = 25.5  # px from a panel to the name of its x axis: ticks of 4, their labels, and what parts them
STYLE: dict[str, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "hdrig",
    "path.simplify": True,
    "path.simplify_threshold": 0.12,  # px: below what a doubled screen can show
    "font.family": ["DejaVu Sans"],  # for the layout only: on a page the fonts come from its style sheet
    "font.size": 12,
    "lines.linewidth": 1.6,
    "lines.solid_capstyle": "round",
    "axes.linewidth": 1.0,
    "text.color": LIGHT["ink"],
    "axes.edgecolor": LIGHT["axis"],
    "axes.labelcolor": LIGHT["muted"],
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.spines.left": False,
    "axes.axisbelow": True,
    "axes.xmargin": 0.0,
    "axes.grid": True,
    "axes.grid.axis": "y",
    "grid.color": LIGHT["grid"],
    "grid.linewidth": 1.0,
    "xtick.color": LIGHT["axis"],
    "xtick.labelcolor": LIGHT["muted"],
    "xtick.labelsize": 11.5,
    "xtick.major.size": 4.0,
    "xtick.major.pad": 6.0,
    "ytick.color": LIGHT["muted"],
    "ytick.labelsize": 11.5,
    "ytick.major.size": 0.0,
    "ytick.major.pad": 6.0,
    "axes.unicode_minus": True,
    "axes.formatter.useoffset": False,  # it would stand over the title
}
"""What a panel begins with: told beforehand, for each tick that is changed later is made anew."""


@dataclass(frozen=True)
class Frame:
    """What a figure is drawn for: width in CSS px, and the word across it ("SIMULATED", or "" for none)."""

    width: float = 760.0
    mark: str = ""

    @property
    def narrow(self) -> bool:
        """A phone: fewer ticks, legends in a line of their own."""
        return self.width < 520

    def pick(self, wide: float, narrow: float) -> float:
        """One of two, by width."""
        return narrow if self.narrow else wide


@dataclass(frozen=True)
class Drawing:
    """One figure of the catalogue: what it is called, how it is read, how it is drawn."""

    name: str  # also the anchor on the page
    title: str
    note: str  # definition and reading, printed beside it
    draw: Callable[[Curves, Frame], Figure | None]
    say: Callable[[Curves], str]  # what a screen reader says
    named: Callable[[Curves], tuple[str, str]] | None = None  # title and note, where they depend on what is drawn
    full: bool = False  # takes the whole width of a printed page; else two stand side by side


def sheet(frame: Frame, heights: Sequence[float], *, keys: int = 0, right: float = 14.0) -> tuple[Figure, list[Any]]:
    """A figure of panels below each other over one x axis, `heights` in px, each with its title above it.

    `keys` lines are left for the key between the first title and its panel; `right` is the margin in px. The word of
    the frame stands across every panel.
    """
    top = HEAD + KEY * keys
    total = top + sum(heights) + (BETWEEN + HEAD) * (len(heights) - 1) + FOOT
    figure = Figure(figsize=(frame.width * PX, total * PX), dpi=72)
    figure.patch.set_visible(False)
    panels = []
    for height in heights:
        panels.append(panel_at(figure, frame, (LEFT, top, frame.width - LEFT - right, height)))
        top += height + BETWEEN + HEAD
    for panel in panels[:-1]:
        panel.tick_params(axis="x", labelbottom=False)
    return figure, panels


def panel_at(figure: Figure, frame: Frame, box: tuple[float, float, float, float]) -> Axes:
    """A panel of the sheet's look at (left, top, width, height) in px, the word of the frame across it."""
    left, top, width, height = box
    total = figure.get_figheight() / PX
    place = (left / frame.width, 1 - (top + height) / total, width / frame.width, height / total)
    panel = figure.add_axes(place, axes_class=Panel)
    _quiet(panel)
    if frame.mark:
        _watermark(panel, frame.mark, width, height)
    return panel


def _quiet(panel: Axes) -> None:
    panel.patch.set_visible(False)
    panel.yaxis.set_major_locator(MaxNLocator(5, min_n_ticks=3))
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_label_coords(0.0, 0.0)  # else the ticks are laid out twice, to find a place for a name


def _watermark(panel: Axes, word: str, width: float, height: float) -> None:
    size = min(height * 0.42, width / (0.78 * len(word)))  # px: the word fills the panel and leaves it
    panel.text(
        0.5,
        0.5,
        word,
        transform=panel.transAxes,
        fontsize=size,
        fontweight="bold",
        rotation=min(14.0, np.degrees(np.arctan2(height, width)) * 0.6),
        rotation_mode="anchor",
        ha="center",
        va="center",
        color=LIGHT["mark"],
        alpha=0.09,
        zorder=-1,
    )


def title(panel: Axes, name: str, unit: str, *, keys: int = 0) -> None:
    """What the panel shows and its unit, above its left end and above `keys` lines of key."""
    panel.annotate(
        f"{name}, {unit}",
        (0, 1),
        (2 - LEFT, 10 + KEY * keys),
        "axes fraction",
        textcoords="offset points",
        fontweight="bold",
    )


def key(panel: Axes, handles: Sequence[Any], columns: int = 0) -> None:
    """The key of lines: at the right of the title, or with `columns` in lines of that many below it."""
    panel.legend(
        handles=handles,
        loc="lower left" if columns else "lower right",
        bbox_to_anchor=(0.0, 1.0) if columns else (1.0, 1.0),
        ncols=columns or len(handles),
        frameon=False,
        fontsize=11.5,
        handlelength=1.9,
        handletextpad=0.5,
        columnspacing=1.3,
        labelspacing=0.35,
        borderpad=0.0,
        borderaxespad=0.5,
        labelcolor=LIGHT["ink"],
    )


def angle_axis(panels: Sequence[Axes], frame: Frame) -> None:
    """0 to 360° of the wave generator, named below the last panel."""
    for panel in panels:
        panel.set_xlim(0, 360)
        panel.xaxis.set_major_locator(MultipleLocator(frame.pick(45, 90)))
        panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}°"))
    foot(panels[-1], "Wave-generator angle")


def foot(panel: Axes, text: str) -> None:
    """The name of the x axis."""
    panel.set_xlabel(text, fontsize=11.5)
    panel.xaxis.set_label_coords(0.5, -NAME_BELOW / panel.bbox.height)


def log_axis(panel: Axes, low: float, high: float) -> None:
    """A decade axis from `low` to `high` > 0, labelled 0.01, 0.1, 1, 10 … and 10⁻⁶ beyond."""
    panel.set_yscale("log")
    panel.set_ylim(low, high)
    decades = np.log10(high / low)
    steps = (1.0,) if decades > 2.2 else (1.0, 2.0, 5.0) if decades > 0.7 else tuple(range(1, 10))
    panel.yaxis.set_major_locator(LogLocator(subs=steps, numticks=7))
    panel.yaxis.set_minor_locator(NullLocator())
    panel.yaxis.set_major_formatter(FuncFormatter(lambda y, _: decade(y)))


def decade(value: float) -> str:
    """A tick of a log axis."""
    exponent = int(np.floor(np.log10(value) + 1e-9))
    if -3 <= exponent <= 3:
        return f"{value:.{max(-exponent, 0)}f}"
    lead = round(value / 10.0**exponent)
    return ("" if lead == 1 else f"{lead}·") + "10" + str(exponent).translate(SUPERSCRIPT)
