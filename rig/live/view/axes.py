"""A plane with axes, ticks and units: the viewer has no x-y plot, so frame, numbers and scale are drawn here.

The viewer's own plane has equal scales and y downwards. A picture is WIDTH by HEIGHT of its units, y turned round.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from rig.live.view.ticks import rounded_out, step_for, ticks, written

Array = np.ndarray[Any, Any]

WIDTH, HEIGHT = 200.0, 100.0  # units of the picture
LEFT, RIGHT, ABOVE, BELOW = 26.0, 10.0, 16.0, 20.0  # room for numbers and words beside the frame
SHRINK = 0.45  # an axis is drawn anew when what it shows fills less than this share of it


@dataclass(frozen=True)
class Axis:
    """One axis: what it shows, in which unit, from where to where, and how far apart its ticks are."""

    label: str
    unit: str
    low: float
    high: float
    most: int = 6  # parts between ticks
    step: float | None = None  # where a round step is not what people expect: 45° of a turn

    @property
    def values(self) -> list[float]:
        """Where its ticks are."""
        return ticks(self.low, self.high, self.most, self.step)

    @property
    def words(self) -> list[str]:
        """The ticks' numbers."""
        step = self.step or step_for(self.high - self.low, self.most)
        return [written(value, step) for value in self.values]

    @property
    def title(self) -> str:
        """What it shows, with its unit."""
        return f"{self.label} [{self.unit}]"

    def share(self, values: Array) -> Array:
        """Where values lie along the axis, 0 to 1 within it."""
        return (np.asarray(values, dtype=np.float64) - self.low) / (self.high - self.low)

    def fitted(self, low: float, high: float) -> Axis:
        """An axis that shows low to high: this very one where it does already, and not far too wide."""
        if not (math.isfinite(low) and math.isfinite(high)):
            return self
        inside = self.low <= low and high <= self.high
        if inside and high - low >= SHRINK * (self.high - self.low):
            return self
        start, end = rounded_out(low, high, self.most)
        if inside and end - start >= self.high - self.low:
            return self
        return Axis(self.label, self.unit, start, end, self.most, self.step)


@dataclass(frozen=True)
class Frame:
    """Two axes; `place` puts data where they belong in the picture."""

    x: Axis
    y: Axis

    def place(self, x: Array, y: Array) -> Array:
        """Data, each shape (n,), as points of the picture, shape (n, 2) float32. Rows with a NaN are left out."""
        points = np.stack((self.x.share(x) * WIDTH, (1.0 - self.y.share(y)) * HEIGHT), axis=-1)
        return np.asarray(points[np.isfinite(points).all(axis=-1)], dtype=np.float32)

    def grid(self) -> list[Array]:
        """A line across the picture at every tick, each shape (2, 2)."""
        upright = [_line((s * WIDTH, 0.0), (s * WIDTH, HEIGHT)) for s in self.x.share(np.array(self.x.values))]
        level = [_line((0.0, y), (WIDTH, y)) for y in (1.0 - self.y.share(np.array(self.y.values))) * HEIGHT]
        return upright + level

    def border(self) -> Array:
        """The frame itself, closed, shape (5, 2)."""
        corners = [(0.0, 0.0), (WIDTH, 0.0), (WIDTH, HEIGHT), (0.0, HEIGHT), (0.0, 0.0)]
        return np.array(corners, dtype=np.float32)

    def numbers(self) -> tuple[Array, list[str]]:
        """Where the ticks' numbers stand, shape (n, 2), and the numbers."""
        below = [(s * WIDTH, HEIGHT + 1.5) for s in self.x.share(np.array(self.x.values))]
        beside = [(-11.0, y - 3.5) for y in (1.0 - self.y.share(np.array(self.y.values))) * HEIGHT]
        return np.array(below + beside, dtype=np.float32), self.x.words + self.y.words

    def titles(self) -> tuple[Array, list[str]]:
        """Where the axes' titles stand, shape (2, 2), and the titles."""
        where = [(WIDTH / 2, HEIGHT + 9.0), (32.0, -10.0)]
        return np.array(where, dtype=np.float32), [self.x.title, self.y.title]


def bounds() -> tuple[tuple[float, float], tuple[float, float]]:
    """What of the picture has to be seen: x from, to; y from, to."""
    return (-LEFT, WIDTH + RIGHT), (-ABOVE, HEIGHT + BELOW)


def _line(a: tuple[float, float], b: tuple[float, float]) -> Array:
    return np.array([a, b], dtype=np.float32)
