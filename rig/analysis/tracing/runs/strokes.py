"""A motion forth and back in its strokes."""

from __future__ import annotations

import itertools

import numpy as np

from rig.model.effect import Array


def strokes(theta: Array) -> list[slice]:
    """Rows lo..hi between reversals of the motor angle; parts too short to compare are left out."""
    if theta.size < 3:
        return []
    wide = max(3, theta.size // 400)
    slow = np.convolve(theta, np.ones(wide) / wide, mode="valid")
    step = np.sign(np.diff(slow))
    step[step == 0] = 1
    cuts = [0, *(int(c) + 1 + wide // 2 for c in np.flatnonzero(np.diff(step))), theta.size]
    return [slice(lo, hi) for lo, hi in itertools.pairwise(cuts) if hi - lo > 25]


def wound_back(theta: Array, least: float) -> list[int]:
    """Rows at which an angle (n,) is largest, or smallest, before it goes back by `least` or more."""
    out: list[int] = []
    top = low = 0
    for row, x in enumerate(theta.tolist()):
        if x > theta[top]:
            top = row
        if x < theta[low]:
            low = row
        if theta[top] - x >= least and (not out or out[-1] != top) and top > low:
            out.append(top)
            low = row
        elif x - theta[low] >= least and (not out or out[-1] != low) and low > top:
            out.append(low)
            top = row
    return out
