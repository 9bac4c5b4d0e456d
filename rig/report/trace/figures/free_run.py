"""The kinematic error of held-out runs, measured and simulated with nothing of the load side given."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, line
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.numbers import plain
from rig.report.trace.figures.style import AFTER, BEFORE, MEASURED, handle, titled


def runs(curves: Curves) -> list[str]:
    """Runs that were simulated."""
    names = (stem.removeprefix("free_rms.") for stem in curves if stem.startswith("free_rms."))
    return [name for name in names if axis(curves, f"free.{name}.turns") is not None]


def _lines(curves: Curves, run: str) -> tuple[Array, list[Array]]:
    turns = np.asarray(curves[f"free.{run}.turns"], dtype=np.float64)
    found = [line(curves, f"free.{run}.{n}", turns.size) for n in ("measured", "before", "after")]
    return turns, [np.full(turns.size, np.nan) if y is None else y for y in found]


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses free.<run>.turns, .measured, .before, .after (n,) and free_rms.<run> (2,)."""
    shown = runs(curves)
    if not shown:
        return None
    furthest = max(float(curves[f"free.{run}.turns"].max(initial=0.0)) for run in shown)  # the panels share an axis
    figure, panels = sheet(frame, [frame.pick(150, 130)] * len(shown), keys=1)
    for i, (panel, run) in enumerate(zip(panels, shown, strict=True)):
        turns, lines = _lines(curves, run)
        for y, style in zip(lines, (MEASURED, BEFORE, AFTER), strict=True):
            panel.plot(turns, y, **style)
        panel.set_xlim(0, max(furthest, 1e-6))
        panel.yaxis.set_major_locator(MaxNLocator(5))
        title(panel, titled(run, frame), "arcsec", keys=int(i == 0))
    names = ("measured", "before", "after") if frame.narrow else ("measured", "simulated before", "simulated after")
    key(panels[0], [handle(s, n) for s, n in zip((MEASURED, BEFORE, AFTER), names, strict=True)], columns=3)
    foot(panels[-1], "Motor turns")
    return figure


def say(curves: Curves) -> str:
    """The figure in words."""
    parts = []
    for run in runs(curves):
        before, after = (plain(float(x), 2) for x in np.asarray(curves[f"free_rms.{run}"], dtype=np.float64))
        parts.append(f"{run}: RMS {before} arcsec off before, {after} after")
    return (
        "Kinematic error by free simulation over two motor turns, or until the motor turns back. "
        + "; ".join(parts)
        + "."
    )


DRAWING = Drawing(
    "free-run",
    "Kinematic error by free simulation",
    "The whole model solved in time for the motor's recorded motion, as in the paper's Fig. 7 and 11: load angle and "
    "shaft torque are simulated, never read, so that errors can build up in the gear's resonance. RMS over the first "
    "seconds of the run, after its start is forgotten; what the gear does at random is in the measurement alone.",
    draw,
    say,
)
