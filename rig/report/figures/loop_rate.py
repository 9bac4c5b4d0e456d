"""Half width of the lock test's loop against the rate of the ramps: viscous loss grows with it, hysteresis does not."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rig.report.figures.arrays import line
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.figures.direction import FIT_DASH
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses loop.rate, .half_width (n,), arcmin/s and N·m, and loop.fit (2,): N·m and N·m per arcmin/s."""
    rate = line(curves, "loop.rate")
    half = None if rate is None else line(curves, "loop.half_width", len(rate))
    if rate is None or half is None or not np.nanmax(rate) > 0:
        return None
    figure, (panel,) = sheet(frame, [frame.pick(190, 170)])
    panel.axhline(0, color=LIGHT["axis"], lw=1)
    handles = panel.plot(rate, half, "o", color=LIGHT["forward"], ms=4.5, label="one ramp")
    fit = line(curves, "loop.fit", 2)
    if fit is not None and not np.isnan(fit).any():
        ends = np.array([0.0, float(np.nanmax(rate))])
        handles += panel.plot(ends, fit[0] + fit[1] * ends, color=LIGHT["fit"], lw=2.0, ls=FIT_DASH, label="line")
    panel.set_xlim(0, 1.05 * float(np.nanmax(rate)))
    title(panel, "Half width of the loop at zero torque", "N·m")
    key(panel, handles)
    foot(panel, "Rate of wind-up, arcmin/s")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    rate, half = line(curves, "loop.rate"), line(curves, "loop.half_width")
    if rate is None or half is None:
        return "Half width of the loop against the rate of wind-up."
    return (
        f"Half width of the loop at zero torque of {len(rate)} ramps from {plain(np.nanmin(rate), 2)} to "
        f"{plain(np.nanmax(rate), 2)} arcmin/s: {plain(np.nanmin(half), 3)} to {plain(np.nanmax(half), 3)} N·m."
    )


DRAWING = Drawing(
    "loop-rate",
    "Loop against rate",
    "A loop of viscous loss widens in proportion to the rate and has no width at no rate; a hysteretic one is as wide "
    "at any rate. Each dot is one ramp.",
    draw,
    say,
)
