"""Columns of the bank as they are kept: single precision, each in one stretch of memory."""

from __future__ import annotations

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


class Sheet:
    """A block as it is made, term after term, each laid beside those before: held one by one and put together at the
    end, they would want twice the memory, and the machine takes longer to give it than they take to compute."""

    def __init__(self, eq: Equations, key: Key, rows: Index, room: int) -> None:
        """For those `rows` (m,) of the channel, and `room` columns to begin with."""
        self._eq, self._key, self._rows = eq, key, rows
        self._columns = np.empty((room, rows.size), np.float32)  # the machine gives no memory before it is written to
        self._widths: list[int] = []
        self._products: list[Array] = []
        self._used = 0

    def add(self, x: Array | None) -> None:
        """The columns of a term (n, k), all rows; None of one that does not act there."""
        if x is not None:
            laid(self._eq, self._key, x, self._rows, mine := self._next(x.shape[1]))
            double = mine.astype(np.float64)
            self._products.append((double @ double.T).ravel())
        self._widths.append(0 if x is None else x.shape[1])

    def add_zeros(self, width: int) -> None:
        """So many columns of nothing, or none where the term does not act."""
        self._next(width)[:] = 0.0
        self._products.append(np.zeros(width**2))
        self._widths.append(width)

    def _next(self, width: int) -> Single:
        """Room for so many more columns, (width, m)."""
        first, self._used = self._used, self._used + width
        if self._used > len(self._columns):
            self._columns = np.vstack([self._columns[:first], np.empty((first + width, self._rows.size), np.float32)])
        return self._columns[first : self._used]

    @property
    def widths(self) -> list[int]:
        """Columns of each term so far."""
        return self._widths

    def block(self) -> Block | None:
        """All of it; None where nothing acts."""
        if not self._used:
            return None
        self._columns.resize((self._used, self._rows.size), refcheck=False)  # what `add` looked through is gone
        return Block(self._columns.T, np.array(self._widths), np.concatenate(self._products))


def _first_of(has: Index, wide: Index) -> Index:
    """Places of the first `has` of every `wide` columns."""
    starts = np.concatenate([[0], np.cumsum(wide)])
    return np.concatenate([start + np.arange(n) for start, n in zip(starts, has, strict=False)])


def laid(eq: Equations, key: Key, x: Array, rows: Index, out: Single) -> None:
    """Those `rows` (m,) of columns `x` (n, k) without what the run has to itself, in single precision, to `out`
    (k, m)."""
    if key not in eq.local:
        _lay(x, rows, eq.share_of_mean(key, rows.size), out)
    else:
        x = x[rows]
        out[:] = eq.bare(key, x).T if np.isfinite(x).all() else 0.0


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
