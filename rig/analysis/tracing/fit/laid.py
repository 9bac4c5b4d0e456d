"""Columns of the bank as they are kept: single precision, each in one stretch of memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.model.effect import Array

Single = npt.NDArray[np.float32]
Index = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Block:
    """One run's part of the bank in one channel: columns of all terms side by side (n, c), how many each term has (t,),
    and the products of each term's columns with each other, term after term (Σ k²,)."""

    columns: Single
    widths: Index
    products: Array

    @classmethod
    def of(cls, made: Sequence[Single | None]) -> Block:
        """From the columns of each term (k, n), None of one that does not act there."""
        double = [m.astype(np.float64) for m in made if m is not None]
        products = np.concatenate([(m @ m.T).ravel() for m in double])
        widths = np.array([0 if m is None else len(m) for m in made])
        return cls(np.vstack([m for m in made if m is not None]).T, widths, products)

    def spread(self, wide: Index) -> Block:
        """With as many columns of each term as `wide` (t,) says, those that this run does not have zero."""
        if np.array_equal(self.widths, wide):
            return self
        columns = np.zeros((len(self.columns), wide.sum()), np.float32, order="F")
        columns[:, _first_of(self.widths, wide)] = self.columns
        products = np.zeros(int(np.sum(wide**2)))
        pairs = [
            np.add.outer(k * np.arange(has), np.arange(has)).ravel() for has, k in zip(self.widths, wide, strict=True)
        ]
        starts = np.concatenate([[0], np.cumsum(wide**2)])
        products[np.concatenate([start + at for start, at in zip(starts, pairs, strict=False)])] = self.products
        return Block(columns, wide, products)


def _first_of(has: Index, wide: Index) -> Index:
    """Places of the first `has` of every `wide` columns."""
    starts = np.concatenate([[0], np.cumsum(wide)])
    return np.concatenate([start + np.arange(n) for start, n in zip(starts, has, strict=False)])


def laid(eq: Equations, key: Key, x: Array, rows: Index) -> Single:
    """Those `rows` (m,) of columns `x` (n, k) without what the run has to itself, in single precision, (k, m)."""
    out = np.zeros((x.shape[1], rows.size), np.float32)
    if key not in eq.local:
        _lay(x, rows, eq.share_of_mean(key, rows.size), out)
    elif np.isfinite(x := x[rows]).all():
        out[:] = eq.bare(key, x).T
    return out


@njit(cache=True, nogil=True)
def _lay(x: Array, rows: Index, share: float, out: Single) -> None:
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
