"""How the load follows over one turn of the motor, without and with compensation, forth and back."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rig.report.figures.arrays import line
from rig.report.figures.canvas import Curves, Drawing, Frame, angle_axis, key, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT

INKS = {"without": "muted", "with": "forward"}
DASHES = {"forth": "-", "back": (0, (6, 2))}


def _draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses `<without|with>.<forth|back>`, arcsec over one turn; None when none is there."""
    found = {(which, way): line(curves, f"{which}.{way}") for which in INKS for way in DASHES}
    shown = {at: y for at, y in found.items() if y is not None}
    if not shown:
        return None
    keys = 2 if frame.narrow else 1
    figure, panels = sheet(frame, [frame.pick(240, 200)], keys=keys)
    panels[0].axhline(0, color=LIGHT["axis"], lw=1)
    handles = []
    for (which, way), y in shown.items():
        theta = (np.arange(y.size) + 0.5) / y.size * 360.0
        style = {"color": LIGHT[INKS[which]], "ls": DASHES[way], "lw": 1.6, "label": f"{which}, {way}"}
        handles += panels[0].plot(theta, y, **style)
    title(panels[0], "θ_l − θ_l,ref", "arcsec", keys=keys)
    key(panels[0], handles, columns=4 // keys)
    angle_axis(panels, frame)
    return figure


def _say(curves: Curves) -> str:
    """For a screen reader."""
    spans = [f"{name.replace('.', ', ')} {plain(float(np.ptp(y)), 4)}" for name, y in curves.items()]
    return f"Error of the load over one turn of the motor; peak to peak in arcsec: {'; '.join(spans)}."


DRAWING = Drawing("following", "How the load follows", "", _draw, _say)
