"""Friction against speed: the plateaus' mean torques and the line through them, both directions."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses friction.rpm, friction.total and friction.motor (P,), friction.line_rpm and friction.line (L,); N·m.

    None without at least two plateaus.
    """
    rpm = axis(curves, "friction.rpm")
    total = None if rpm is None else line(curves, "friction.total", len(rpm))
    if rpm is None or total is None:
        return None
    motor = line(curves, "friction.motor", len(rpm))
    at = axis(curves, "friction.line_rpm")
    fitted = None if at is None else line(curves, "friction.line", len(at))
    figure, (panel,) = sheet(frame, [frame.pick(260, 220)], keys=int(frame.pick(1, 2)))
    panel.axhline(0, color=LIGHT["axis"], lw=1)
    style = {"ls": "", "ms": 5.5, "mew": 1.2}
    handles = panel.plot(rpm, total, marker="o", color=LIGHT["bar"], label="all the rig", **style)
    if motor is not None and not np.allclose(motor, total, equal_nan=True):
        handles += panel.plot(rpm, motor, marker="s", mfc="none", color=LIGHT["reverse"], label="motor side", **style)
    if at is not None and fitted is not None:
        for way in (at < 0, at > 0):
            handles += panel.plot(at[way], fitted[way], color=LIGHT["fit"], lw=1.5, label="fitted line")
        handles.pop()
    title(panel, "Torque at the motor", "N·m", keys=int(frame.pick(1, 2)))
    key(panel, handles, columns=int(frame.pick(3, 2)))
    panel.margins(x=0.03)
    foot(panel, "Motor speed, rpm")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    rpm, total = axis(curves, "friction.rpm"), line(curves, "friction.total")
    if rpm is None or total is None:
        return ""
    fastest, slowest = int(np.argmax(np.abs(rpm))), int(np.argmin(np.abs(rpm)))
    return (
        f"Mean motor torque against speed, {len(rpm)} plateaus, from {plain(float(total[slowest]), 3)} N·m at "
        f"{plain(float(rpm[slowest]), 3)} rpm to {plain(float(total[fastest]), 3)} N·m at "
        f"{plain(float(rpm[fastest]), 3)} rpm."
    )


DRAWING = Drawing(
    "friction",
    "Friction against speed",
    "Each point is the mean over whole turns at one speed; rising and falling speeds lie on each other unless the "
    "lubricant warmed up. The step at zero speed is Coulomb friction, the slope is viscous drag.",
    draw,
    say,
)
