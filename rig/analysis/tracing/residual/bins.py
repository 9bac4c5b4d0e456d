"""Bins of what is left in one channel, by one coordinate: index of each row, and where each bin stands on its axis."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from rig.analysis.tracing.residual.joined import Index, Rest
from rig.core.units import TURN
from rig.model.effect import Array

BINS: Final = 24  # of a turn, 15°: finer than the paper's strongest orders, with rows enough in each
LEVELS: Final = 12  # of a range
FEWEST: Final = 30  # rows of a bin: an RMS of fewer scatters by more than an eighth


def rms(e: Array, index: Index, bins: int) -> Array:
    """Of each bin, NaN where it holds too few rows; `index` −1 is left out; (bins,)."""
    inside = index >= 0
    count = np.bincount(index[inside], minlength=bins)
    total = np.bincount(index[inside], e[inside] ** 2, minlength=bins)
    return np.where(count >= FEWEST, np.sqrt(total / np.maximum(count, 1)), np.nan)


def of_turn(name: str) -> Callable[[Rest], tuple[Index, Array] | None]:
    """Bins of an angle."""

    def binned(r: Rest) -> tuple[Index, Array] | None:
        x = r.at[name]
        if not np.isfinite(x).all():
            return None
        index = (np.mod(x, TURN) / TURN * BINS).astype(np.int64) % BINS
        return index, (np.arange(BINS) + 0.5) * 360 / BINS

    return binned


def of_range(name: str, unit: float, knee: float) -> Callable[[Rest], tuple[Index, Array] | None]:
    """Bins of |speed|, torque or time: even up to the `knee` (in shown units), even in the logarithm beyond."""

    def binned(r: Rest) -> tuple[Index, Array] | None:
        x = r.at[name] * unit
        if not np.isfinite(x).all() or np.ptp(x) == 0:
            return None
        x = np.abs(x) if name == "speed" else x
        warped = np.arcsinh(x / knee)
        edges = np.linspace(warped.min(), warped.max(), LEVELS + 1)
        index = np.clip(np.digitize(warped, edges) - 1, 0, LEVELS - 1).astype(np.int64)
        return index, knee * np.sinh((edges[1:] + edges[:-1]) / 2)

    return binned


def of_direction(r: Rest) -> tuple[Index, Array]:
    """Reverse and forward; rows in which it sticks or turns back are left out."""
    way = r.at["direction"]
    return np.where(way > 0.5, 1, np.where(way < -0.5, 0, -1)).astype(np.int64), np.array([-1.0, 1.0])


BINNED: Final[Mapping[str, Callable[[Rest], tuple[Index, Array] | None]]] = {
    "motor_angle": of_turn("motor_angle"),
    "load_angle": of_turn("load_angle"),
    "direction": of_direction,
    "load": of_range("load", 1.0, 1.0),
    "speed": of_range("speed", 60 / TURN, 1.0),
    "time": of_range("time", 1.0, 1e9),
}
