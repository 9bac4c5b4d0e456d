"""Columns times columns."""

from __future__ import annotations

import numpy as np

from rig.model.effect import Array


def times(a: Array, b: Array) -> Array:
    """Every column of `a` (n, k) times every column of `b` (n, m): (n, k·m)."""
    return np.asarray((a[:, :, None] * b[:, None, :]).reshape(a.shape[0], -1))
