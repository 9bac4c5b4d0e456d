"""Columns of the bank as they are kept: single precision, each in one stretch of memory."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.model.effect import Array

Single = npt.NDArray[np.float32]


def laid(eq: Equations, key: Key, x: Array, rows: npt.NDArray[np.int64]) -> Single:
    """Those `rows` (m,) of columns `x` (n, k) without what the run has to itself, in single precision, (k, m)."""
    out = np.zeros((x.shape[1], rows.size), np.float32)
    if key not in eq.local:
        _lay(x, rows, eq.share_of_mean(key, rows.size), out)
    elif np.isfinite(x := x[rows]).all():
        out[:] = eq.bare(key, x).T
    return out


@njit(cache=True, nogil=True)
def _lay(x: Array, rows: npt.NDArray[np.int64], share: float, out: Single) -> None:
    """Rows of columns less a `share` of their mean; nothing where a column is not finite: it explains nothing."""
    for k in range(x.shape[1]):
        total = 0.0
        for i in rows:
            total += x[i, k]
        if not np.isfinite(total):
            out[:] = 0.0
            return
        less = share * total / rows.size
        for m in range(rows.size):
            out[k, m] = x[rows[m], k] - less
