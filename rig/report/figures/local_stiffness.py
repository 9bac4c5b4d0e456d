"""Local stiffness, the slope of torque against wind-up, over torque: measured in a sliding window, and of the law."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.figures.direction import FIT_DASH
from rig.report.numbers import plain
from rig.report.palette import LIGHT

ROOM = 0.08  # of the mean stiffness, shown above and below at least: a tenth of a per cent must not fill the panel


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses tangent.torque, .fit (n,), tangent.measured_torque, .measured (m,); N·m and N·m/rad."""
    torque = axis(curves, "tangent.torque")
    fit = None if torque is None else line(curves, "tangent.fit", len(torque))
    at = line(curves, "tangent.measured_torque")
    measured = None if at is None else line(curves, "tangent.measured", len(at))
    if fit is None and measured is None:
        return None
    figure, (panel,) = sheet(frame, [frame.pick(220, 190)])
    panel.axvline(0, color=LIGHT["axis"], lw=1)
    handles = []
    if at is not None and measured is not None:
        handles += panel.plot(
            at, measured / 1e3, "o", color=LIGHT["forward"], ms=3.5, label="slope over a sliding window"
        )
    if torque is not None and fit is not None:
        handles += panel.plot(torque, fit / 1e3, color=LIGHT["fit"], lw=2.0, ls=FIT_DASH, label="law")
    _room(panel, [y for y in (fit, measured) if y is not None])
    title(panel, "Local stiffness", "kN·m/rad")
    key(panel, handles)
    foot(panel, "Torque, N·m")
    panel.margins(x=0.03)
    return figure


def _room(panel: object, shown: list[Array]) -> None:
    values = np.concatenate(shown) / 1e3
    low, high, mean = float(np.nanmin(values)), float(np.nanmax(values)), abs(float(np.nanmean(values)))
    if np.isfinite(mean) and mean > 0:
        panel.set_ylim(min(low, high - 2 * ROOM * mean) - 0.02 * mean, max(high, low + 2 * ROOM * mean) + 0.02 * mean)  # type: ignore[attr-defined]


def say(curves: Curves) -> str:
    """The figure in words."""
    fit = line(curves, "tangent.fit")
    if fit is None:
        return "Local stiffness over torque, measured in a sliding window."
    low, high = plain(np.nanmin(fit) / 1e3, 4), plain(np.nanmax(fit) / 1e3, 4)
    return f"Local stiffness over torque: the fitted law goes from {low} to {high} kN·m/rad."


DRAWING = Drawing(
    "local-stiffness",
    "Local stiffness over torque",
    "Slope of torque against wind-up, the loop taken off. Dots: straight lines through the measured points within 12 % "
    "of the largest wind-up either side, no law in them. Dashed: the law named in the headline.",
    draw,
    say,
)
