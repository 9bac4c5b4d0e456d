"""What is drawn over time: one vector of curves a unit, thinned so that no peak is lost."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rig.core.units import ARCSEC, RPM
from rig.live.envelope import extremes, grouped
from rig.live.view import colours
from rig.live.view.about import About
from rig.live.view.block import Block
from rig.live.view.canvas import Canvas
from rig.live.view.lateness import Lateness

Array = np.ndarray[Any, Any]

COLOURS = (colours.FORWARD, colours.REVERSE, colours.GOOD, colours.BRASS, colours.MARK)


@dataclass(frozen=True)
class Curve:
    """One line: its name, its colour, its values in the unit of its group from rows and gear ratio N."""

    name: str
    colour: int
    of: Callable[[Block, float], Array]


Groups = dict[str, tuple[Curve, ...]]
GROUPS: Groups = {
    "/curves/angle": (  # deg at the output
        Curve("θ_ref / N", colours.MUTED, lambda b, n: np.degrees(b["theta_ref"]) / n),
        Curve("θ_m / N", colours.FORWARD, lambda b, n: np.degrees(b["theta_m"]) / n),
        Curve("θ_l", colours.REVERSE, lambda b, n: np.degrees(b["theta_l"])),
    ),
    "/curves/following": (  # deg of the motor
        Curve("θ_ref − θ_m", colours.FORWARD, lambda b, n: np.degrees(b["theta_ref"] - b["theta_m"])),
    ),
    "/curves/error": (  # arcsec at the output      [ghorbel2001, Eq. 1]
        Curve("θ̃", colours.GOOD, lambda b, n: (b["theta_m"] / n - b["theta_l"]) / ARCSEC),
    ),
    "/curves/speed": (Curve("ω_m", colours.FORWARD, lambda b, n: speed(b) / RPM),),  # rpm
    "/curves/motor": (  # N·m, motor side
        Curve("asked", colours.MUTED, lambda b, n: b["tau_ask"]),
        Curve("given", colours.FORWARD, lambda b, n: b["tau_applied"]),
        Curve("reported", colours.REVERSE, lambda b, n: b["tau_m"]),
    ),
    "/curves/shaft": (Curve("τ_l", colours.BRASS, lambda b, n: b["tau_l"]),),  # N·m at the output
}
GAP = 20.0  # periods without a row: more than a loop leaves out unless its machine was away
BEFORE = 1e-6  # s
TICK = "/curves/tick"  # ms


@dataclass(frozen=True)
class More:
    """A group beside those everybody has."""

    path: str
    unit: str
    curves: tuple[Curve, ...]


def all_groups(more: tuple[More, ...]) -> Groups:
    """Curves by path."""
    return {**GROUPS, **{one.path: one.curves for one in more}}


def everything(curve: str) -> bool:
    """While a run goes on nobody knows what will not be measured."""
    return True


class Curves:
    """Sends every group at most one pair of rows for each `every` rows."""

    def __init__(
        self, about: About, every: int, measured: Callable[[str], bool] = everything, more: tuple[More, ...] = ()
    ) -> None:
        """`measured` says which curves, called path and name, have any value at all; the others are left out. `more`
        are groups beside those everybody has.
        """
        self._ratio, self._every = about.ratio, every
        self._lateness = Lateness(1.0 / about.rate if about.rate else 0.0)
        self._period = 1.0 / about.rate if about.rate else math.inf
        self._last = math.inf  # s, of the newest row
        self._heard_by: Canvas | None = None
        self._groups = {
            path: chosen
            for path, group in all_groups(more).items()
            if (chosen := [c for c in group if measured(path + c.name)])
        }

    def begin(self, canvas: Canvas) -> None:
        """Names and colours."""
        for path, group in self._groups.items():
            canvas.name_curves(path, [c.name for c in group], [c.colour for c in group])
        canvas.name_curves(TICK, ["lateness", "age of the oldest value"], [colours.WARN, colours.MUTED])

    def add(self, block: Block, canvas: Canvas) -> None:
        """The next rows."""
        if not len(block):
            return
        lead = self._lead(block, canvas)
        self._last, self._heard_by = float(block.t[-1]), canvas
        late = self._lateness.add(block.t, block["flags"])
        values = [c.of(block, self._ratio) for group in self._groups.values() for c in group]
        # all at once: a call for each curve would cost more than the rows of a block
        t, shown = thinned(block.t, np.stack([*values, late * 1e3, block["age"] * 1e3], axis=1), self._every)
        t, shown = np.concatenate((lead, t)), np.pad(shown, ((len(lead), 0), (0, 0)), constant_values=np.nan)
        sizes = {path: len(group) for path, group in self._groups.items()} | {TICK: 2}
        ends = np.cumsum(list(sizes.values()))[:-1]
        for path, part in zip(sizes, np.split(shown, ends, axis=1), strict=True):
            canvas.curves(path, t, part)

    def _lead(self, block: Block, canvas: Canvas) -> Array:
        """When a line has to end first: rows before these were sent elsewhere, or never read. Shape (0,) or (1,), s."""
        elsewhere = self._heard_by is not None and self._heard_by is not canvas
        broken = elsewhere or block.t[0] - self._last > GAP * self._period
        return block.t[:1] - BEFORE if broken else np.empty(0)


def thinned(t: Array, values: Array, every: int) -> tuple[Array, Array]:
    """Times (n,) and values (n, k) of at most two rows for each `every`.

    What is derived is derived before it is thinned: the extremes of two angles do not belong to one moment.
    """
    if every < 3:
        return t, values
    less = extremes(grouped(np.column_stack((t, values)), every))  # those of t, which grows, are its first and last
    rows = less.reshape(-1, less.shape[-1])
    return rows[:, 0], rows[:, 1:]


def speed(block: Block) -> Array:
    """Motor speed [rad/s], shape (n,): the host's own; where the file has none, the slope of the angle."""
    said = block["omega_m"]
    if not np.isnan(said).all() or len(block) < 2:
        return said
    t = block.t
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.gradient(block["theta_m"], t))


def others(units: dict[str, str]) -> tuple[More, ...]:
    """Channels the table lacks, one group a unit: what another logger had. `units` by name of the channel."""
    found = []
    for number, unit in enumerate(dict.fromkeys(units.values())):
        names = [name for name in units if units[name] == unit]
        curves = tuple(Curve(name, COLOURS[i % len(COLOURS)], _channel(name)) for i, name in enumerate(names))
        found.append(More(f"/curves/other_{number}", unit, curves))
    return tuple(found)


def _channel(name: str) -> Callable[[Block, float], Array]:
    return lambda block, ratio: block[name]


def measured_in(block: Block, ratio: float, more: tuple[More, ...] = ()) -> Callable[[str], bool]:
    """Which curves these rows have at all, by path and name."""
    there = {
        path + curve.name
        for path, group in all_groups(more).items()
        for curve in group
        if np.isfinite(curve.of(block, ratio)).any()
    }
    ages = {TICK} if np.isfinite(block["age"]).any() else set()
    return (there | ages).__contains__
