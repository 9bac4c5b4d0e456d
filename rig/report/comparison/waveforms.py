"""The waveforms of several runs over one another: kinematic error over a turn, or torque against wind-up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, angle_axis, foot, key, sheet, title
from rig.report.figures.kinematic_error import closed
from rig.report.numbers import plain
from rig.report.palette import LIGHT

INKS = ("forward", "reverse", "good", "mark", "level", "bad")  # and never by colour alone:
DASHES = ("-", (0, (6, 2)), (0, (2, 2)), (0, (8, 2, 2, 2)), (0, (1, 1)), (0, (10, 3)))
ERROR = ("ke.theta_deg", "ke.pure")
LOOP = ("lock.windup", "lock.torque")
MOST = 2000  # points of a loop: more than a page is wide


def joined(each: Sequence[Curves | None]) -> dict[str, Array]:
    """The curves of several runs as one, each name with the number of its run before it."""
    return {
        f"{k + 1}:{name}": curves[name]
        for k, curves in enumerate(each)
        if curves
        for name in (*ERROR, *LOOP)
        if name in curves
    }


def drawing(numbers: Sequence[int]) -> Drawing:
    """For the runs of these numbers."""

    def pairs(curves: Curves, names: tuple[str, str]) -> list[tuple[int, Array, Array]]:
        found = []
        for k in numbers:
            x = axis(curves, f"{k}:{names[0]}") if names is ERROR else line(curves, f"{k}:{names[0]}")
            y = None if x is None else line(curves, f"{k}:{names[1]}", len(x))
            if x is not None and y is not None:
                found.append((k, x, y))
        return found

    def draw(curves: Curves, frame: Frame) -> Figure | None:
        errors, loops = pairs(curves, ERROR), pairs(curves, LOOP)
        if not errors and not loops:
            return None
        return _errors(errors, frame) if errors else _loops(loops, frame)

    def say(curves: Curves) -> str:
        said = [f"run {k} {plain(float(np.ptp(y)), 4)}" for k, _, y in pairs(curves, ERROR) or pairs(curves, LOOP)]
        return f"Waveforms of the runs over one another; span of each: {', '.join(said)}."

    return Drawing("waveforms", "Waveforms over one another", NOTE, draw, say)


NOTE = (
    "Runs of turning: E, the part of θ_m/N − θ_l that is the same in both directions, over one turn of the wave "
    "generator, its mean taken off; at speed it holds what the flexible gear adds. Lock tests: shaft torque against "
    "wind-up. Each is analysed anew from its samples, about the zero of its own encoder: the "
    "same gear may be shifted once the encoder was powered anew."
)


def _style(k: int) -> dict[str, object]:
    return {"color": LIGHT[INKS[(k - 1) % len(INKS)]], "ls": DASHES[(k - 1) % len(DASHES)], "label": f"run {k}"}


def _errors(found: list[tuple[int, Array, Array]], frame: Frame) -> Figure:
    figure, panels = sheet(frame, [frame.pick(260, 220)], keys=1)
    panels[0].axhline(0, color=LIGHT["axis"], lw=1)
    handles = []
    for k, theta, values in found:
        handles += panels[0].plot(*closed(theta, values - np.nanmean(values)), lw=1.6, **_style(k))
    title(panels[0], "θ̃ over one turn", "arcsec", keys=1)
    key(panels[0], handles, columns=6)
    angle_axis(panels, frame)
    return figure


def _loops(found: list[tuple[int, Array, Array]], frame: Frame) -> Figure:
    figure, panels = sheet(frame, [frame.pick(320, 250)], keys=1)
    handles = []
    for k, windup, torque in found:
        step = max(len(windup) // MOST, 1)
        handles += panels[0].plot(windup[::step], torque[::step], lw=1.1, **_style(k))
    panels[0].margins(x=0.03)
    title(panels[0], "Shaft torque", "N·m", keys=1)
    key(panels[0], handles, columns=6)
    foot(panels[0], "Wind-up at the output, arcmin")
    return figure
