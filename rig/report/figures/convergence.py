"""Mean square of what a Fourier series of k terms leaves, against k: how many terms the error needs."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, line, scalar
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, log_axis, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses mse.k, mse.value (k,), mse.floor (1,), arcsec²; mse.chosen (1,), the terms used. None without values."""
    k = axis(curves, "mse.k")
    value = None if k is None else line(curves, "mse.value", len(k))
    if k is None or value is None or not (value > 0).any():
        return None
    floor, chosen = scalar(curves, "mse.floor"), scalar(curves, "mse.chosen")
    positive = value[value > 0]
    least = min(positive.min(), floor) if floor is not None and floor > 0 else positive.min()
    figure, (panel,) = sheet(frame, [frame.pick(220, 200)])
    log_axis(panel, least / 6, float(positive.max()) * 2)
    shown = np.where(value > 0, value, np.nan)
    panel.plot(k, shown, color=LIGHT["bar"], lw=1.4, marker="o", ms=5, mec=LIGHT["bar"], mfc=LIGHT["bar"])
    if floor is not None and floor > 0:
        _mark_floor(panel, floor)
    at = np.flatnonzero(k == chosen)
    if at.size and np.isfinite(shown[at[0]]):
        _mark_chosen(panel, k, (k[at[0]], shown[at[0]]))
    panel.set_xlim(k.min() - 0.6, k.max() + 0.6)
    panel.xaxis.set_major_locator(MaxNLocator(int(frame.pick(16, 8)), integer=True, steps=[1, 2, 5, 10]))
    title(panel, "Mean square left over", "arcsec²")
    foot(panel, "Number of Fourier terms k")
    return figure


def _mark_floor(panel: Axes, floor: float) -> None:
    panel.axhline(floor, color=LIGHT["level"], lw=1.4, ls=(0, (5, 3)))
    panel.annotate(
        f"noise floor {plain(floor, 2)} arcsec²",
        (0, floor),
        (4, -15),
        panel.get_yaxis_transform(),
        textcoords="offset points",
        fontsize=11,
        color=LIGHT["level"],
    )


def _mark_chosen(panel: Axes, k: Array, place: tuple[float, float]) -> None:
    """A ring about the number of terms used, of those `k` that are drawn, and the number in words."""
    panel.plot(*place, marker="o", ms=12, mfc="none", mec=LIGHT["ink"], mew=1.5, ls="none", clip_on=False)
    late = place[0] > k.min() + 0.6 * (k.max() - k.min())  # no room at the right: below, the curve comes from above
    panel.annotate(
        f"{place[0]:g} terms used",
        place,
        (6, -19) if late else (9, 12),
        textcoords="offset points",
        ha="right" if late else "left",
        fontsize=11.5,
        fontweight="bold",
    )


def say(curves: Curves) -> str:
    """The figure in words."""
    k, value = axis(curves, "mse.k"), line(curves, "mse.value")
    if k is None or value is None:
        return ""
    floor, chosen = scalar(curves, "mse.floor"), scalar(curves, "mse.chosen")
    said = f"Mean square left over: {plain(value[0], 3)} arcsec² with {k[0]:g} terms"
    said += f", {plain(value[-1], 3)} arcsec² with {k[-1]:g}"
    said += f"; noise floor {plain(floor, 2)} arcsec²" if floor is not None else ""
    return said + (f"; {chosen:g} terms are used." if chosen is not None else ".")


DRAWING = Drawing(
    "convergence",
    "Terms of the Fourier series",
    "Mean square of what a series of k terms leaves of the kinematic error. The floor is what the scatter of "
    "single revolutions leaves in their mean: terms below it describe noise.",
    draw,
    say,
)
