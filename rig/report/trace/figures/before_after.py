"""Measured, model before and model after, over two motor turns of a slow, a fast and a loaded held-out run."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, MultipleLocator

from rig.report.figures.arrays import axis, line, span
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, foot, key, sheet, title
from rig.report.numbers import plain
from rig.report.palette import LIGHT
from rig.report.trace.channels import CHANNELS, Channel
from rig.report.trace.figures.style import AFTER, BEFORE, MEASURED, handle, titled


def chosen(curves: Curves, channel: Channel) -> dict[str, str]:
    """Held-out runs by what they stand for: slowest and fastest of the least loaded, most loaded; each once."""
    names = (stem.removeprefix("run_at.") for stem in curves if stem.startswith("run_at."))
    at = {
        name: np.asarray(curves[f"run_at.{name}"], dtype=np.float64)
        for name in names
        if axis(curves, f"close.{name}.{channel.letter}.turns") is not None
    }
    if not at:
        return {}
    least = min(abs(v[1]) for v in at.values())
    free = [n for n, v in at.items() if abs(v[1]) <= least + 0.5]  # N·m: the weights of a rig differ by more
    slow, fast = min(free, key=lambda n: abs(at[n][0])), max(free, key=lambda n: abs(at[n][0]))
    loaded = max(at, key=lambda n: abs(at[n][1]))
    found = {"slow": slow}
    if abs(at[fast][0]) > 1.5 * abs(at[slow][0]):
        found["fast"] = fast
    if abs(at[loaded][1]) > least + 0.5:
        found["loaded"] = loaded
    return found


def draw(curves: Curves, frame: Frame, channel: Channel) -> Figure | None:
    """Uses close.<run>.<C>.turns, .measured, .before, .after (n,) and run_at.<run> (2,)."""
    runs = chosen(curves, channel)
    if not runs:
        return None
    figure, panels = sheet(frame, [frame.pick(130, 115), frame.pick(62, 58)] * len(runs), keys=1)
    for i, (kind, run) in enumerate(runs.items()):
        above, below = panels[2 * i : 2 * i + 2]
        turns, measured, before, after = _columns(curves, channel, run)
        _trace(above, turns, ((measured, MEASURED), (before, BEFORE), (after, AFTER)))
        left = ((measured - before, {**BEFORE, "ls": "-"}), (measured - after, AFTER))
        _trace(below, turns, left)
        below.yaxis.set_major_locator(MaxNLocator(3))
        for panel in (above, below):
            panel.set_xlim(0, 2)
            panel.xaxis.set_major_locator(MultipleLocator(frame.pick(0.25, 0.5)))
        stands_for = f"{kind.capitalize()}: " if len(runs) > 1 else ""  # one run alone is neither slow nor fast
        title(
            above, f"{stands_for}{titled(run, frame)}, {_condition(curves, run, frame)}", channel.unit, keys=int(i == 0)
        )
        title(below, "Measured less model", channel.unit)
    names = ("measured", "before", "after") if frame.narrow else ("measured", "model before", "model after")
    key(panels[0], [handle(s, n) for s, n in zip((MEASURED, BEFORE, AFTER), names, strict=True)], columns=3)
    foot(panels[-1], "Motor turns")
    return figure


def _trace(panel: Axes, turns: Array, lines: Sequence[tuple[Array, dict[str, Any]]]) -> None:
    panel.axhline(0, color=LIGHT["axis"], lw=1)
    for y, style in lines:
        panel.plot(turns, y, **style)
    ends = span(*(y for y, _ in lines))
    if ends is not None:
        room = 0.1 * (ends[1] - ends[0] or 1.0)
        panel.set_ylim(ends[0] - room, ends[1] + room)


def _columns(curves: Curves, channel: Channel, run: str) -> tuple[Array, Array, Array, Array]:
    """Motor turns, measured, model before, model after, in the unit shown; NaN where a column is not there."""
    stem = f"close.{run}.{channel.letter}"
    turns = np.asarray(curves[f"{stem}.turns"], dtype=np.float64)
    found = (line(curves, f"{stem}.{n}", turns.size) for n in ("measured", "before", "after"))
    measured, before, after = (np.full(turns.size, np.nan) if y is None else y * channel.scale for y in found)
    return turns, measured, before, after


def _condition(curves: Curves, run: str, frame: Frame) -> str:
    speed, load = np.asarray(curves[f"run_at.{run}"], dtype=np.float64)
    if frame.narrow:
        return f"{plain(load, 3)} N·m" if abs(load) > 0.5 else f"{plain(speed, 3)} rpm"
    return f"{plain(speed, 3)} rpm, " + (f"{plain(load, 3)} N·m through the gear" if abs(load) > 0.05 else "no load")


def say(curves: Curves, channel: Channel) -> str:
    """The figure in words."""
    said = []
    for kind, run in chosen(curves, channel).items():
        _, measured, *models = _columns(curves, channel, run)
        left = [plain(float(np.sqrt(np.mean((measured - m) ** 2))), 2) for m in models]
        said.append(f"{kind} run {run}: RMS {left[0]} {channel.unit} off before, {left[1]} after")
    return f"{channel.name} over two motor turns, measured and modelled. " + "; ".join(said) + "."


NOTES = {
    "A": "θ̃ = θ_m/N − θ_l as measured in runs the fit did not see, and what the model says before and after, for the "
    "torque that was measured. Each curve less its mean over the run. The wind-up under load is part of it.",
    "M": "τ_m − T/N: what friction, inertia and the slope of the kinematic error take, as measured in runs the fit did "
    "not see, and what the model says. Each curve less what the run has to itself.",
    "L": "Shaft torque and external torque together, as measured in runs the fit did not see, and what inertia and "
    "friction of the load say. Each curve less what the run has to itself.",
}


def _drawing(channel: Channel) -> Drawing:
    return Drawing(
        f"before-after-{channel.sensor.replace('_', '-')}",
        f"{channel.name}: measured, model before, model after",
        NOTES[channel.letter],
        partial(draw, channel=channel),
        partial(say, channel=channel),
    )


KINEMATIC_ERROR, MOTOR_TORQUE, SHAFT_TORQUE = map(_drawing, CHANNELS)
