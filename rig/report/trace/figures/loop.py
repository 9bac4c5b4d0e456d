"""Torque against wind-up of held-out runs with a locked output: measured, model before, model after."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import line, span
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT
from rig.report.trace.figures.style import AFTER, BEFORE, MEASURED, handle, titled

MOST = 700  # points of a loop: a loop is smooth, and there are four of them


def runs(curves: Curves) -> list[str]:
    """Locked runs with all columns, largest torque first; two at most."""
    stems = [name.removesuffix(".windup_arcsec") for name in curves if name.startswith("loop.")]
    stems = [s for s in dict.fromkeys(stems) if _columns(curves, s) is not None]
    return sorted(stems, key=lambda s: -float(np.ptp(np.nan_to_num(curves[f"{s}.torque_Nm"]))))[:2]


def _columns(curves: Curves, stem: str) -> tuple[Array, Array, Array, Array] | None:
    torque = line(curves, f"{stem}.torque_Nm")
    if torque is None:
        return None
    rest = [line(curves, f"{stem}.{n}_arcsec", len(torque)) for n in ("windup", "before", "after")]
    found = [torque, *(r for r in rest if r is not None)]
    if len(found) < 4:
        return None
    step = max(1, len(torque) // MOST)
    torque, windup, before, after = (v[::step] for v in found)
    return torque, windup, before, after


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses loop.<run>.torque_Nm, .windup_arcsec, .before_arcsec, .after_arcsec (n,)."""
    shown = runs(curves)
    if not shown:
        return None
    figure, panels = sheet(frame, [frame.pick(170, 150), frame.pick(180, 160)] * len(shown), keys=1)
    for i, stem in enumerate(shown):
        found = _columns(curves, stem)
        if found is None:
            continue
        torque, windup, before, after = found
        above, below = panels[2 * i : 2 * i + 2]
        for y, style in ((windup, MEASURED), (before, BEFORE), (after, AFTER)):
            above.plot(torque, y, **{**style, "lw": style["lw"] * 0.8})
        below.plot(torque, windup - before, color=BEFORE["color"], lw=1.0, alpha=0.85)
        below.plot(torque, windup - after, color=AFTER["color"], lw=1.0)
        for panel, ends in ((above, span(windup, before, after)), (below, span(windup - before, windup - after))):
            panel.axhline(0, color=LIGHT["axis"], lw=1)
            panel.margins(x=0.02)
            panel.xaxis.set_major_locator(MaxNLocator(9))
            if ends is not None:
                room = 0.06 * (ends[1] - ends[0] or 1.0)
                panel.set_ylim(ends[0] - room, ends[1] + room)
        title(above, f"Wind-up, {titled(stem.removeprefix('loop.'), frame)}", "arcsec", keys=int(i == 0))
        title(below, "Measured less model", "arcsec")
        foot(below, "Torque through the gear, N·m")
        below.tick_params(axis="x", labelbottom=True)
    names = ("measured", "before", "after") if frame.narrow else ("measured", "model before", "model after")
    key(panels[0], [handle(s, n) for s, n in zip((MEASURED, BEFORE, AFTER), names, strict=True)], columns=3)
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for stem in runs(curves):
        found = _columns(curves, stem)
        if found is not None:
            _, windup, *models = found
            left = [plain(float(np.sqrt(np.nanmean((windup - m) ** 2))), 2) for m in models]
            said.append(f"{stem.removeprefix('loop.')}: RMS {left[0]} arcsec off before, {left[1]} after")
    return "Wind-up of the locked gear against torque, measured and modelled. " + "; ".join(said) + "."


DRAWING = Drawing(
    "loop",
    "Wind-up against torque, output locked",
    "Held-out runs with the output locked. A straight line is a constant stiffness; a bend, a step at zero or a loop "
    "in what is left is one that the model lacks. Wind-up is θ̃ less its mean over the run.",
    draw,
    say,
)
