"""Curves over one turn of the wave generator: every revolution and their mean, or measured beside the model."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, line, rows, thin
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, angle_axis, key, sheet, title
from rig.report.figures.kinematic_error import closed
from rig.report.numbers import plain
from rig.report.palette import LIGHT

MOST = 40  # revolutions drawn; more only thicken the band
LINES: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("pure", "θ̃_p, slow run", {"color": LIGHT["axis"], "lw": 1.5, "ls": (0, (5, 2))}),
    ("measured", "measured", {"color": LIGHT["forward"], "lw": 2.2}),
    ("sensor", "torque sensor over K", {"color": LIGHT["level"], "lw": 1.7, "ls": (0, (3, 1.5))}),
    ("model", "model", {"color": LIGHT["reverse"], "lw": 1.7, "ls": (0, (7, 2.2))}),
)


def draw_turns(curves: Curves, frame: Frame) -> Figure | None:
    """Uses turn.theta_deg (G,), turn.measured (G,), turn.revolutions (R, G), arcsec. None without the first two."""
    theta = axis(curves, "turn.theta_deg")
    measured = None if theta is None else line(curves, "turn.measured", len(theta))
    if theta is None or measured is None:
        return None
    figure, (panel,) = sheet(frame, [frame.pick(290, 230)])
    handles: list[Any] = []
    each = rows(curves, "turn.revolutions", len(theta))
    if each is not None:
        handles.append(_revolutions(panel, theta, each))
    handles += panel.plot(*closed(theta, measured), color=LIGHT["forward"], lw=2.2, label="mean, 15 orders")
    title(panel, "θ̃", "arcsec")
    key(panel, handles)
    angle_axis([panel], frame)
    return figure


def _revolutions(panel: Axes, theta: Array, each: Array) -> object:
    shown = thin(each, MOST)
    lines = [np.column_stack((theta[::2], r[::2])) for r in shown]
    panel.add_collection(LineCollection(lines, colors=LIGHT["forward-soft"], linewidths=0.7, alpha=0.6, zorder=1.5))
    panel.autoscale_view()
    label = f"{len(shown)} of {len(each)} turns" if len(shown) < len(each) else f"{len(each)} turns"
    return panel.plot([], [], color=LIGHT["forward-soft"], lw=1.4, label=label)[0]


def draw_compared(curves: Curves, frame: Frame) -> Figure | None:
    """Uses turn.theta_deg, turn.measured (G,), arcsec, and .model, .left, .pure, .sensor where they are."""
    theta = axis(curves, "turn.theta_deg")
    if theta is None or line(curves, "turn.measured", len(theta)) is None:
        return None
    left = line(curves, "turn.left", len(theta))
    found = [(line(curves, f"turn.{name}", len(theta)), word, style) for name, word, style in LINES]
    there = [(c, word, style) for c, word, style in found if c is not None]
    columns = int(frame.pick(0, 2)) if len(there) > 1 else 0
    keys = -(-len(there) // columns) if columns else 0
    figure, panels = sheet(frame, [frame.pick(250, 210)] + [frame.pick(74, 70)] * (left is not None), keys=keys)
    for panel in panels:
        panel.axhline(0, color=LIGHT["axis"], lw=1)
    handles = [h for c, word, style in there for h in panels[0].plot(*closed(theta, c), label=word, **style)]
    title(panels[0], "Kinematic error", "arcsec", keys=keys)
    if len(there) > 1:
        key(panels[0], handles, columns)
    if left is not None:
        _left(panels[1], theta, left, line(curves, "turn.left_loaded", len(theta)))
        panels[1].yaxis.set_major_locator(MaxNLocator(3))
        title(panels[1], "Measured less model", "arcsec")
    angle_axis(panels, frame)
    return figure


def _left(panel: Axes, theta: Array, left: Array, loaded: Array | None) -> None:
    """What the model leaves, and what it leaves once its pure error depends on the load."""
    handles = panel.plot(*closed(theta, left), color=LIGHT["ink"], lw=1.3, label="model")
    if loaded is not None:
        style: dict[str, Any] = {"color": LIGHT["good"], "lw": 1.6, "ls": (0, (4, 1.6))}
        handles += panel.plot(*closed(theta, loaded), label="with θ̃_p as under that load", **style)
        key(panel, handles)


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for name, word, _ in LINES:
        values = line(curves, f"turn.{name}")
        if values is not None:
            said.append(f"{word}: {plain(float(np.ptp(values)), 3)} arcsec peak to peak")
    return "Kinematic error over one turn of the wave generator. " + "; ".join(said) + "."


TURNS = Drawing("turns", "", "", draw_turns, say)
COMPARED = Drawing("compared", "", "", draw_compared, say)
