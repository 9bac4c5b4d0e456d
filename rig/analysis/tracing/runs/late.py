"""A channel brought forward by how late it is read: a filter of its own delays all that it lets through alike."""

from __future__ import annotations

import numpy as np

from rig.model.effect import Array


def earlier(x: Array, rows: float) -> Array:
    """`x` (n,) as it is `rows` later, by a cubic through four neighbours, so that a missing row spoils no more than
    four; beyond its ends it stays as it is there."""
    whole = int(np.floor(rows))
    f = rows - whole
    weights = (
        -f * (f - 1) * (f - 2) / 6,
        (f + 1) * (f - 1) * (f - 2) / 2,
        -(f + 1) * f * (f - 2) / 2,
        (f + 1) * f * (f - 1) / 6,
    )
    at = np.arange(x.size) + whole
    return np.asarray(sum(w * x[np.clip(at + k, 0, x.size - 1)] for k, w in zip((-1, 0, 1, 2), weights, strict=True)))
