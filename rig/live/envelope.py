"""Fewer rows that hide no peak: of every so many, the smallest and the largest value of each channel."""

from __future__ import annotations

from typing import Any

import numpy as np

from rig.core.ring import NO_COUNTS

Rows = np.ndarray[Any, Any]


def envelope(block: Rows, every: int) -> Rows:
    """Two rows for each `every` rows of `block`, shape (n,) → (2·⌈n/every⌉,), with the same fields.

    Of every float channel the extremes of the group stand in the order in which they came; NaN only where the whole
    group is NaN, so a peak beside a gap is kept. `t` grows, so its extremes are the first and the last time of the
    group. Quality bits are joined: both rows carry every bit of the group. `every` < 3 gains nothing: `block` itself.
    """
    if every < 3 or not len(block):
        return block
    out = np.empty(2 * -(-len(block) // every), block.dtype)
    for name in block.dtype.names or ():
        values = grouped(block[name], every)
        pairs = _bits(values) if name == "flags" else extremes(values)
        out[name] = pairs.ravel()
    return out


def grouped(values: Rows, every: int) -> Rows:
    """`values` (n, …) as (⌈n/every⌉, every, …); the last group is filled up with its last value, no new extreme."""
    groups = -(-len(values) // every)
    return values[np.minimum(np.arange(groups * every), len(values) - 1)].reshape(groups, every, *values.shape[1:])


def extremes(values: Rows) -> Rows:
    """Smallest and largest of each group (groups, every, …) in time order, (groups, 2, …). What was not measured is
    no extreme.
    """
    missing = np.isnan(values) if values.dtype.kind == "f" else values == NO_COUNTS
    top = np.inf if values.dtype.kind == "f" else np.iinfo(values.dtype).max
    low = np.argmin(np.where(missing, top, values), axis=1)
    high = np.argmax(np.where(missing, -top, values), axis=1)
    places = np.sort(np.stack((low, high), axis=1), axis=1)
    return np.take_along_axis(values, places, axis=1)


def _bits(values: Rows) -> Rows:
    joined = np.bitwise_or.reduce(values, axis=1)
    return np.stack((joined, joined), axis=1)
