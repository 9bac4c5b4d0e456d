"""Stamps that jitter beside rows that do not: which of the two a run's angle goes by.

A drive answers a clock's every tick, and the stamp is when the answer was read: a scheduler makes it late by a
millisecond, in which a motor at 600 rpm goes 4 degrees. Or rows come when they come, and the stamp is right. The angle
tells: what was taken evenly is smooth over the rows' count, what was not over the stamps.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.runs.grid import is_even
from rig.model.effect import Array

SMOOTHER: Final = 1.5  # times: of even rows noise alone leaves as much either way
JITTERS: Final = 0.02  # of the distance between rows, RMS: less is no matter
STEP: Final = 0.6  # of that distance: a row that was lost moves all stamps after it by one
AROUND: Final = 8  # rows on either side by which that is told from a late stamp
SLOWLY: Final = 1.0  # s over which the logger's clock may drift against the rows'
FEWEST: Final = 100  # rows


def evened(t: Array, angle: Array | None, dt: float) -> tuple[Array, str]:
    """Times of the rows [s] (n,), usually `dt` apart: as they are stamped, or as they were taken, evenly; and a
    sentence on that, "" where they are as stamped."""
    if angle is None or t.size < FEWEST or is_even(t, dt) or not np.isfinite(angle).all():
        return t, ""
    even = _even(t, dt)
    jitter = float(np.std(t - even))
    by_stamps, by_count = _roughness(t, angle), _roughness(even, angle)
    if jitter < JITTERS * dt or by_count * SMOOTHER > by_stamps or np.any(np.diff(even) <= 0):
        return t, ""
    note = (
        f"its time stamps jitter by {1e3 * jitter:.2g} ms, its rows were taken evenly, one every {1e3 * dt:.3g} ms: "
        f"over their count the angle is {by_stamps / by_count:.1f} times smoother, and that is taken for their time"
    )
    return even, note


def _even(t: Array, dt: float) -> Array:
    """Stamps without what they jitter by, (n,): the rows' count, what the clock drifts, and rows that were lost."""
    count = dt * np.arange(t.size)
    late = t - count
    lost = _lost(late, dt)
    drift = late - dt * lost
    return np.asarray(count + dt * lost + _slow(drift, max(3, round(SLOWLY / dt))))


def _lost(late: Array, dt: float) -> Array:
    """Rows lost so far, (n,), from how `late` stamps are against the count [s]: all after such a row are later."""
    windows = np.lib.stride_tricks.sliding_window_view(late, AROUND)
    usual = np.median(windows, axis=1)
    step = np.zeros(late.size)
    step[AROUND : late.size - AROUND + 1] = usual[AROUND:] - usual[:-AROUND]
    lost = np.zeros(late.size)
    found = np.flatnonzero(np.abs(step) > STEP * dt)
    for near in np.split(found, np.flatnonzero(np.diff(found) > AROUND) + 1) if found.size else ():
        most = near[np.argmax(np.abs(step[near]))]
        rows = np.round(step[most] / dt)
        lost[_since(late, usual[most - AROUND], rows * dt, near[0] - AROUND, near[-1] + AROUND) :] += rows
    return lost


def _since(late: Array, before: float, shift: float, first: int, last: int) -> int:
    """The row from `first` to `last` since which `late` is by `shift` more than `before` [s]: with the least that is
    off either, as one late stamp jumps further than a lost row."""
    off = late[first:last] - before
    return first + int(np.argmin(np.cumsum((np.abs(off - shift) - np.abs(off))[::-1])[::-1]))


def _slow(x: Array, rows: int) -> Array:
    """Without what changes faster than over so many `rows`, (n,): a line, and a mean around each row of what is left
    of it, which at either end is that of the rows nearest to it."""
    i = np.arange(x.size)
    line = np.polyval(np.polyfit(i, x, 1), i)
    half = min(rows, x.size // 2) // 2
    rest = x - line
    wide = np.pad(rest, half, constant_values=(rest[: 2 * half + 1].mean(), rest[-2 * half - 1 :].mean()))
    total = np.concatenate([[0.0], np.cumsum(wide)])
    return np.asarray(line + (total[2 * half + 1 :] - total[: -2 * half - 1]) / (2 * half + 1))


def _roughness(t: Array, x: Array) -> float:
    """By how much a reading is off the cubic through the two before and the two after it, in the unit of `x`: the
    middle one of all."""
    at = np.stack([t[i : t.size - 4 + i] for i in range(5)])
    off = np.array(x[2:-2])
    with np.errstate(divide="ignore", invalid="ignore"):  # two rows of one stamp tell nothing
        for i in (0, 1, 3, 4):
            others = [j for j in (0, 1, 3, 4) if j != i]
            far, near = (np.prod([at[k] - at[j] for j in others], axis=0) for k in (2, i))
            off -= far / near * x[i : x.size - 4 + i]
    return float(np.median(np.abs(off[np.isfinite(off)]))) if np.isfinite(off).any() else 0.0
