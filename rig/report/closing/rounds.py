"""Figure: the error on held-out runs over its floor, round by round, without and with what was found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from rig.analysis.tracing.fit.channels import SENSOR_NAMES
from rig.analysis.tracing.thresholds import EXPLAINED
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, log_axis, sheet, title
from rig.report.palette import LIGHT
from rig.report.trace.figures.style import AFTER, BEFORE, FLOOR, handle

NAMES: Final = {sensor: word.capitalize() for sensor, word in SENSOR_NAMES.items()}
ROOM: Final = 0.35  # of a round, left and right of the first and the last


def curves(rounds: Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """`rounds.number` (r,), and `rounds.<sensor>.before` and `.after` (r,): RMS over floor, NaN where not measured."""
    out = {"rounds.number": np.array([float(r["number"]) for r in rounds])}
    for sensor in NAMES:
        for when in ("before", "after"):
            values = np.array([float(r[f"over_floor_{when}"].get(sensor, np.nan)) for r in rounds])
            if np.isfinite(values).any():
                out[f"rounds.{sensor}.{when}"] = values
    return out


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses what `curves` makes. None without rounds or errors."""
    number, shown = curves.get("rounds.number"), _measured(curves)
    if number is None or not shown:
        return None
    figure, panels = sheet(frame, [frame.pick(92, 84)] * len(shown), keys=1)
    for sensor, panel in zip(shown, panels, strict=True):
        pair = _pair(curves, sensor)
        values = np.concatenate(pair)
        log_axis(panel, min(0.5, 0.8 * float(np.nanmin(values))), max(3.0, 1.5 * float(np.nanmax(values))))
        panel.axhline(1.0, **FLOOR)
        panel.axhline(EXPLAINED, color=LIGHT["grid"], lw=1.4)
        for x, style, filled in zip(pair, (BEFORE, AFTER), (False, True), strict=True):
            face = style["color"] if filled else LIGHT["paper"]
            panel.plot(number, x, **style, marker="o", ms=6, mfc=face, mec=style["color"], clip_on=False, zorder=3)
        title(panel, NAMES[sensor], "RMS over floor", keys=int(panel is panels[0]))
    key(panels[0], [handle(BEFORE, "paper’s model"), handle(AFTER, "with what was found"), handle(FLOOR, "floor")], 3)
    for panel in panels:
        panel.set_xlim(number.min() - ROOM, number.max() + ROOM)
        panel.xaxis.set_major_locator(FixedLocator(list(number)))
        panel.xaxis.set_major_formatter(lambda x, _: f"{x:g}")
    foot(panels[-1], "Round")
    return figure


def _measured(curves: Curves) -> list[str]:
    """Sensors with both curves."""
    return [s for s in NAMES if {f"rounds.{s}.before", f"rounds.{s}.after"} <= curves.keys()]


def _pair(curves: Curves, sensor: str) -> tuple[Array, Array]:
    return curves[f"rounds.{sensor}.before"], curves[f"rounds.{sensor}.after"]


def say(curves: Curves) -> str:
    """The figure in words."""
    said = []
    for sensor in _measured(curves):
        steps = ", ".join(f"{a:.2f} to {b:.2f}" for a, b in zip(*_pair(curves, sensor), strict=True) if b == b)
        said.append(f"{NAMES[sensor]} {steps}")
    return f"Error over its floor without and with what was found, round by round. {'; '.join(said)}."


DRAWING: Final = Drawing(
    "rounds",
    "From round to round",
    "RMS of measured less model on held-out runs, over what repeats of a run differ by, on a logarithmic scale. "
    f"At 1 a model can be no closer; above the grey line, {EXPLAINED:g}, a channel is not explained. Every round is "
    "fitted anew to all runs made until then, so that both lines move.",
    draw,
    say,
)
