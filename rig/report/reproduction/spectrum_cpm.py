"""Amplitudes by frequency, cycles per minute, on a linear axis as the paper has them."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Curves, Drawing, Frame, foot, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses spectrum.cpm, spectrum.cpm_amplitude (n,), arcsec. None without them."""
    cpm = axis(curves, "spectrum.cpm")
    amplitude = None if cpm is None else line(curves, "spectrum.cpm_amplitude", len(cpm))
    if cpm is None or amplitude is None:
        return None
    figure, (panel,) = sheet(frame, [frame.pick(270, 220)])
    panel.fill_between(cpm, 0, amplitude, color=LIGHT["bar-soft"], lw=0)
    panel.plot(cpm, amplitude, color=LIGHT["bar"], lw=1.3)
    top = int(np.nanargmax(amplitude))
    panel.annotate(
        f"{cpm[top]:.0f} cycles/min", (cpm[top], amplitude[top]), (10, -6), textcoords="offset points",
        fontsize=12, fontweight="bold",
    )  # fmt: skip
    panel.set_ylim(0, float(np.nanmax(amplitude)) * 1.08)
    panel.set_xlim(0, float(cpm[-1]))
    panel.xaxis.set_major_locator(MaxNLocator(int(frame.pick(8, 5)), steps=[1, 2, 3, 6, 10]))
    title(panel, "Amplitude of θ̃", "arcsec")
    foot(panel, "Frequency, cycles per minute")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    cpm, amplitude = axis(curves, "spectrum.cpm"), line(curves, "spectrum.cpm_amplitude")
    if cpm is None or amplitude is None:
        return ""
    top = int(np.nanargmax(amplitude))
    return f"Spectrum of the kinematic error; largest {plain(amplitude[top], 3)} arcsec at {cpm[top]:.0f} cycles/min."


DRAWING = Drawing("spectrum-cpm", "", "", draw, say)
