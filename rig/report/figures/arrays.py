"""Reading curves that may be absent, empty or not finite: a figure asks, and gets an array worth drawing or None."""

from __future__ import annotations

import numpy as np

from rig.report.figures.canvas import Array, Curves


def line(curves: Curves, name: str, length: int | None = None) -> Array | None:
    """The curve as float64, shape (n,); None when absent, of another length, or without two finite points."""
    found = curves.get(name)
    if found is None:
        return None
    values = np.asarray(found, dtype=np.float64)
    if values.ndim != 1 or (length is not None and len(values) != length) or np.isfinite(values).sum() < 2:
        return None
    return np.where(np.isfinite(values), values, np.nan)


def axis(curves: Curves, name: str) -> Array | None:
    """The same for what is drawn along x: also None when it has gaps or does not extend anywhere."""
    values = line(curves, name)
    return None if values is None or np.isnan(values).any() or np.ptp(values) == 0 else values


def rows(curves: Curves, name: str, length: int) -> Array | None:
    """Several curves as float64, shape (R, `length`), less those without two finite points; None when none remain."""
    found = curves.get(name)
    if found is None:
        return None
    values = np.atleast_2d(np.asarray(found, dtype=np.float64))
    if values.ndim != 2 or values.shape[1] != length:
        return None
    values = values[np.isfinite(values).sum(axis=1) >= 2]
    return np.where(np.isfinite(values), values, np.nan) if len(values) else None


def scalar(curves: Curves, name: str) -> float | None:
    """The one number of a curve of length 1; None when absent or not finite."""
    values = np.asarray(curves.get(name, ()), dtype=np.float64).ravel()
    return float(values[0]) if values.size == 1 and np.isfinite(values[0]) else None


def band(curves: Curves, name: str, length: int) -> tuple[Array, Array] | None:
    """`name`_min and `name`_max, each shape (`length`,); None unless both are there."""
    low, high = line(curves, f"{name}_min", length), line(curves, f"{name}_max", length)
    return None if low is None or high is None else (low, high)


def thin(values: Array, most: int) -> Array:
    """At most `most` rows of `values` (R, G), evenly picked from first to last."""
    if len(values) <= most:
        return values
    return np.asarray(values[np.unique(np.linspace(0, len(values) - 1, most).round().astype(int))])


def columns(x: Array, low: Array, high: Array, most: int) -> tuple[Array, Array, Array]:
    """An envelope in at most `most` columns: least of the lows and greatest of the highs of each, at its middle x.

    All shape (n,) in, (≤ `most`,) out. Columns without a finite value are NaN: a gap stays a gap.
    """
    if len(x) <= most:
        return x, low, high
    edges = np.linspace(0, len(x), most + 1).round().astype(int)[:-1]
    least = np.fmin.reduceat(low, edges)
    greatest = np.fmax.reduceat(high, edges)
    middle = np.add.reduceat(x, edges) / np.diff(np.append(edges, len(x)))
    return middle, least, greatest


def span(*curves: Array | None) -> tuple[float, float] | None:
    """Least and greatest finite value of all of them."""
    ends = [(np.nanmin(c), np.nanmax(c)) for c in curves if c is not None and np.isfinite(c).any()]
    return (float(min(e[0] for e in ends)), float(max(e[1] for e in ends))) if ends else None
