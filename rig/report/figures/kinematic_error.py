"""Kinematic error over one turn of the wave generator: every revolution, the means, the Fourier fit; and below, what
each direction is apart from the fit, where a tenth of the error fills the strip.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from rig.report.figures.arrays import axis, line, rows, span, thin
from rig.report.figures.canvas import Array, Curves, Drawing, Frame, angle_axis, key, sheet, title
from rig.report.figures.direction import FIT_DASH, FORWARD, REVERSE, Direction
from rig.report.numbers import estimate, plain
from rig.report.palette import LIGHT

MOST = 40  # revolutions drawn per direction; more only thicken the band


class Side(NamedTuple):
    """What was recorded in one direction; (R, G) and (G,), arcsec."""

    direction: Direction
    revolutions: Array | None
    mean: Array | None


def closed(theta: Array, values: Array) -> tuple[Array, Array]:
    """A periodic curve with its last point again before the first and its first after the last: it spans 0° to 360°."""
    around = np.concatenate((theta[-1:] - 360.0, theta, theta[:1] + 360.0))
    return around, np.concatenate((values[-1:], values, values[:1]))


def sides(curves: Curves, length: int) -> list[Side]:
    """Both directions, those without any curve left out."""
    found = [
        Side(d, rows(curves, f"ke.revolutions_{d.name}", length), line(curves, f"ke.mean_{d.name}", length))
        for d in (FORWARD, REVERSE)
    ]
    return [side for side in found if side.revolutions is not None or side.mean is not None]


def draw(curves: Curves, frame: Frame) -> Figure | None:
    """Uses ke.theta_deg (G,), ke.revolutions_* (R, G), ke.mean_*, ke.pure, ke.fit (G,), arcsec; ke.peak_to_peak (3,),
    value and ends of its interval, at the dimension line. None without a curve.
    """
    theta = axis(curves, "ke.theta_deg")
    if theta is None:
        return None
    both = sides(curves, len(theta))
    fit, pure = line(curves, "ke.fit", len(theta)), line(curves, "ke.pure", len(theta))
    best = fit if fit is not None else pure
    if best is None and not both:
        return None
    apart = both if best is not None else []
    entries = sum((s.revolutions is not None) + (s.mean is not None) for s in both) + (best is not None)
    columns = int(frame.pick(5, 2))
    keys = -(-entries // columns)
    heights = [frame.pick(310, 250)] + [frame.pick(76, 76)] * len(apart)
    figure, panels = sheet(frame, heights, keys=keys, right=frame.pick(96, 14))
    handles = _overlay(panels[0], frame, theta, both)
    if best is not None:
        style: dict[str, Any] = (
            {"ls": FIT_DASH, "label": "Fourier fit"} if fit is not None else {"label": "mean of both"}
        )
        handles += panels[0].plot(*closed(theta, best), color=LIGHT["fit"], lw=2.0, zorder=4, **style)
    title(panels[0], what(curves), "arcsec", keys=keys)
    key(panels[0], handles, columns)
    shown = best if best is not None else next((s.mean for s in both if s.mean is not None), None)
    if shown is not None and not frame.narrow:
        _dimension(panels[0], shown, line(curves, "ke.peak_to_peak", 3))
    strips = [_apart(panel, frame, theta, side, best) for panel, side in zip(panels[1:], apart, strict=True)]
    for panel, side in zip(panels[1:], apart, strict=True):
        panel.set_ylim(*_limits(strips))  # one scale, so that the directions can be compared
        less = "the fit" if fit is not None else "the mean of both"
        title(panel, f"{side.direction.name.capitalize()} less {less}", "arcsec")
    angle_axis(panels, frame)
    return figure


def _overlay(panel: Axes, frame: Frame, theta: Array, both: Sequence[Side]) -> list[Any]:
    handles: list[Any] = []
    for direction, revolutions, _ in both:
        if revolutions is not None:
            handles.append(_revolutions(panel, frame, theta, revolutions, direction))
    for direction, _, mean in both:
        if mean is not None:
            label = f"mean, {direction.name}"
            handles += panel.plot(*closed(theta, mean), color=direction.colour, ls=direction.dash, lw=1.8, label=label)
    return handles


def _revolutions(panel: Axes, frame: Frame, theta: Array, revolutions: Array, direction: Direction) -> Line2D:
    shown = thin(revolutions, MOST)
    stride = max(1, int(len(theta) / frame.width * 1.3))  # no more points than pixels
    lines = [np.column_stack((theta[::stride], r[::stride])) for r in shown]
    panel.add_collection(LineCollection(lines, colors=direction.soft, linewidths=0.7, alpha=0.55, zorder=1.5))
    panel.autoscale_view()
    count = f"{len(revolutions)}" if len(shown) == len(revolutions) else f"{len(shown)} of {len(revolutions)}"
    turns = "turn" if len(revolutions) == 1 else "turns"
    return Line2D([], [], color=direction.soft, lw=1.4, label=f"{count} {turns} {direction.name}")


def _apart(panel: Axes, frame: Frame, theta: Array, side: Side, best: Array | None) -> tuple[float, float] | None:
    """One direction less the best curve; gives its span, that of the revolutions without their rarest spikes."""
    assert best is not None
    panel.axhline(0, color=LIGHT["axis"], lw=1)
    panel.yaxis.set_major_locator(MaxNLocator(3))
    rest = None if side.revolutions is None else side.revolutions - best
    mean = None if side.mean is None else side.mean - best
    if rest is not None:
        _revolutions(panel, frame, theta, rest, side.direction)
    if mean is not None:
        panel.plot(*closed(theta, mean), color=side.direction.colour, ls=side.direction.dash, lw=1.5)
    usual = None if rest is None or not np.isfinite(rest).any() else np.nanpercentile(rest, [0.5, 99.5])
    return span(usual, mean)


def _limits(spans: Sequence[tuple[float, float] | None]) -> tuple[float, float]:
    """From the least to the greatest of all spans and zero, with a margin."""
    low = min([0.0, *(s[0] for s in spans if s)])
    high = max([0.0, *(s[1] for s in spans if s)])
    margin = 0.15 * (high - low) or 1.0
    return low - margin, high + margin


def _dimension(panel: Axes, values: Array, stated: Array | None) -> None:
    """A dimension line right of the panel: from the least to the greatest of the curve, and how far that is."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    place = panel.get_yaxis_transform()
    for level in (low, high):
        panel.plot([1.008, 1.034], [level, level], transform=place, color=LIGHT["ink"], lw=1, clip_on=False)
    panel.plot([1.021, 1.021], [low, high], transform=place, color=LIGHT["ink"], lw=1, clip_on=False)
    number = plain(high - low, 3) if stated is None else estimate(stated[0], (stated[1], stated[2])).split(" ")[0]
    for text, lift, size, weight, colour in (
        (number, 3.0, 16, "bold", "ink"),
        ("arcsec", -12.0, 11, "normal", "muted"),
        ("peak to peak", -25.0, 11, "normal", "muted"),
    ):
        panel.annotate(
            text,
            (1.021, (low + high) / 2),
            (9, lift),
            place,
            textcoords="offset points",
            fontsize=size,
            fontweight=weight,
            color=LIGHT[colour],
            annotation_clip=False,
        )


def say(curves: Curves) -> str:
    """The figure in words."""
    theta = axis(curves, "ke.theta_deg")
    length = 0 if theta is None else len(theta)
    parts = []
    for direction, revolutions, mean in sides(curves, length):
        if revolutions is not None:
            parts.append(f"{len(revolutions)} revolutions {direction.name}")
        if mean is not None:
            ends = f"{plain(float(np.nanmin(mean)), 3)} to {plain(float(np.nanmax(mean)), 3)}"
            parts.append(f"mean {direction.name} from {ends} arcsec")
    fit = line(curves, "ke.fit", length)
    if fit is not None:
        parts.append(f"Fourier fit with {plain(float(np.nanmax(fit) - np.nanmin(fit)), 3)} arcsec peak to peak")
    return f"{what(curves)} in arcsec over one turn of the wave generator: " + "; ".join(parts) + "."


def what(curves: Curves) -> str:
    """Only a slow run shows the kinematic error; at speed θ̃ has what inertia and friction add in it."""
    speed = curves.get("ke.at_speed")
    if speed is None:
        return "Kinematic error"
    rpm = float(speed[0]) if np.size(speed) else float("nan")
    return f"θ̃ at {plain(rpm, 4)} rpm" if np.isfinite(rpm) else "θ̃ at speed"


def named(curves: Curves) -> tuple[str, str]:
    """Title and caption."""
    term = what(curves)
    first = "Kinematic error is the" if term == "Kinematic error" else "θ̃ is the"
    at_speed = "" if term == "Kinematic error" else "At this speed inertia and friction are in it. "
    return f"{term} over one turn of the wave generator", f"{first} {NOTE_MIDDLE} {at_speed}{NOTE_END}"


NOTE_MIDDLE = (
    "motor angle divided by the gear ratio, less the load angle: positive when the "
    "load lags. It is referred to the output; its constant part and its slow trend are taken out."
)
NOTE_END = (
    "The bracket is the peak to peak of the fitted series, not of the drawn mean curves. Peak to "
    "peak is per wave-generator turn, as in the paper; the maker’s transmission accuracy is over one output "
    "turn and is not the same. Below, each direction less the fit, on a scale of its own."
)
DRAWING = Drawing(
    "kinematic-error",
    *named({}),
    draw,
    say,
    named,
    full=True,
)
