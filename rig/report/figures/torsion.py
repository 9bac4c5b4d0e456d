"""Torsion against torque: the loop of a lock test, and the lines fitted to it."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.figures.direction import FIT_DASH
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses torsion.torque, torsion.angle (n,), torsion.fit_torque, torsion.fit_angle (m,), N·m and arcmin."""
    torque = line(curves, "torsion.torque")
    angle = None if torque is None else line(curves, "torsion.angle", len(torque))
    fit_torque = line(curves, "torsion.fit_torque")
    fit_angle = None if fit_torque is None else line(curves, "torsion.fit_angle", len(fit_torque))
    if angle is None and fit_angle is None:
        return None
    departure = _departure(torque, angle, fit_torque, fit_angle)
    heights = [frame.pick(300, 240)] + [110.0] * (departure is not None)
    figure, panels = sheet(frame, heights)
    panel, handles = panels[0], []
    for each in panels:
        each.grid(axis="x", color=LIGHT["grid"], linewidth=1.0)
        each.axhline(0, color=LIGHT["axis"], lw=1)
        each.axvline(0, color=LIGHT["axis"], lw=1)
        each.margins(x=0.03)
        each.xaxis.set_major_locator(MaxNLocator(int(frame.pick(10, 6))))
    if angle is not None:
        handles += panel.plot(torque, angle, color=LIGHT["forward"], lw=1.3, label="measured")
    if fit_angle is not None:
        handles += panel.plot(fit_torque, fit_angle, color=LIGHT["fit"], lw=2.2, ls=FIT_DASH, label="fitted")
    title(panel, "Torsion at the output", "arcmin")
    key(panel, handles)
    if departure is not None:
        panels[1].plot(torque, departure, color=LIGHT["forward"], lw=1.3)
        panels[1].set_xlim(panel.get_xlim())
        title(panels[1], "Measured less fitted", "arcsec")
    foot(panels[-1], "Torque, N·m")
    return figure


def _departure(
    torque: Array | None, angle: Array | None, fit_torque: Array | None, fit_angle: Array | None
) -> Array | None:
    """Measured less fitted torsion, arcsec, where the fitted lines are a function of torque; None otherwise."""
    if torque is None or angle is None or fit_torque is None or fit_angle is None:
        return None
    if not (np.isfinite(fit_torque).all() and np.isfinite(fit_angle).all() and (np.diff(fit_torque) > 0).all()):
        return None
    inside = (torque >= fit_torque[0]) & (torque <= fit_torque[-1])
    return np.where(inside, angle - np.interp(torque, fit_torque, fit_angle), np.nan) * 60.0 if inside.any() else None


def say(curves: Curves) -> str:
    """The figure in words."""
    torque, angle = line(curves, "torsion.torque"), line(curves, "torsion.angle")
    if torque is None or angle is None:
        return "Torsion against torque, fitted lines."
    return (
        f"Torsion against torque: {plain(np.nanmin(angle), 3)} to {plain(np.nanmax(angle), 3)} arcmin "
        f"for {plain(np.nanmin(torque), 3)} to {plain(np.nanmax(torque), 3)} N·m."
    )


DRAWING = Drawing(
    "torsion",
    "Torsion against torque",
    "Torsion is the motor angle divided by the gear ratio, less the load angle; the kinematic error at these "
    "motor angles is still in it. The slope is the compliance of the whole path between the encoders: gear, "
    "torque sensor, couplings and fixture together. The loop width is the distance between its branches at zero "
    "torque, along the torsion axis.",
    draw,
    say,
)
