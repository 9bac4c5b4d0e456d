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
