"""The paper's Fig. 13: shaft torque against wind-up of the locked gear, with the fitted lines."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import line
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.figures.direction import FIT_DASH
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses lock.windup, .torque, .departure (n,), lock.fit_windup, .fit_torque (m,); arcmin and N·m."""
    windup = line(curves, "lock.windup")
    torque = None if windup is None else line(curves, "lock.torque", len(windup))
    if windup is None or torque is None:
        return None
    departure = line(curves, "lock.departure", len(windup))
    figure, panels = sheet(frame, [frame.pick(320, 250)] + [120.0] * (departure is not None))
    for panel in panels:
        panel.grid(axis="x", color=LIGHT["grid"], linewidth=1.0)
        panel.axhline(0, color=LIGHT["axis"], lw=1)
        panel.axvline(0, color=LIGHT["axis"], lw=1)
        panel.margins(x=0.03)
        panel.xaxis.set_major_locator(MaxNLocator(int(frame.pick(10, 6))))
    handles = panels[0].plot(windup, torque, color=LIGHT["forward"], lw=1.2, label="measured")
    fit_windup = line(curves, "lock.fit_windup")
    fit_torque = None if fit_windup is None else line(curves, "lock.fit_torque", len(fit_windup))
    if fit_windup is not None and fit_torque is not None:
        style = {"color": LIGHT["fit"], "lw": 2.0, "ls": FIT_DASH, "marker": "o", "ms": 4.5, "mfc": LIGHT["paper"]}
        handles += panels[0].plot(fit_windup, fit_torque, label="K1, K2, K3", **style)
    title(panels[0], "Shaft torque", "N·m")
    key(panels[0], handles)
    if departure is not None:
        panels[1].plot(windup, departure, color=LIGHT["forward"], lw=1.0)
        panels[1].set_xlim(panels[0].get_xlim())
        title(panels[1], "Measured less fitted lines: the loop", "N·m")
    foot(panels[-1], "Wind-up at the output, arcmin")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    windup, torque = line(curves, "lock.windup"), line(curves, "lock.torque")
    if windup is None or torque is None:
        return "Shaft torque against wind-up of the locked gear."
    return (
        f"Shaft torque against wind-up of the locked gear: {plain(np.nanmin(torque), 3)} to "
        f"{plain(np.nanmax(torque), 3)} N·m over {plain(np.nanmin(windup), 3)} to {plain(np.nanmax(windup), 3)} arcmin."
    )


DRAWING = Drawing(
    "lock",
    "Torque against wind-up, output locked",
    "Wind-up is the motor angle divided by the gear ratio, less the load angle, less the kinematic error where a slow "
    "run of it was at hand. The lines are K1, K2, K3 of the whole path between the encoders, gear, torque sensor, "
    "couplings and fixture together; circles mark where they meet. The loop below is what is left of the measurement "
    "when the lines are taken off.",
    draw,
    say,
)
