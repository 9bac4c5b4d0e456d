"""The rest as a sum: one value a bin of some coordinate, a zero of each run's own, and a change of the baseline.

The baseline was fitted without the coordinate and has taken on of it what it can: what an even spring does in a lock
test is in the pure kinematic error as well. Left as it is, that share of it is seen as something else elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

from rig.analysis.tracing.rest.joined import Index, Rest
from rig.model.effect import Array

FEWEST = 8  # rows of a bin: of fewer the mean is noise
LEAST = 0.05  # of the floor squared: less is no excess to share out
EVEN = 1e-6  # of a column: keeps zeros, and what is in the baseline, where nothing ties them to each other

Rows = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Beside:
    """Zeros of the runs in their order (r,) and changes of the baseline's coefficients (p,)."""

    runs: Array
    zeros: Array
    shift: Array

    def of(self, r: Rest) -> Array:
        """What it foretells of every row, (n,); a run that was not fitted has no zero."""
        place = np.searchsorted(self.runs, r.run).clip(max=self.runs.size - 1)
        known = self.runs[place] == r.run
        return np.asarray(np.where(known, self.zeros[place], 0.0) + r.z @ self.shift)


@dataclass(frozen=True)
class Binned:
    """Values of bins (b,), NaN where there were too few rows, and what stands beside them."""

    values: Array
    beside: Beside

    def guess(self, index: Index) -> Array:
        """Value of the bin of each row, NaN where there is none; (n,)."""
        inside = (index >= 0) & (index < self.values.size)
        return np.where(inside, self.values[np.where(inside, index, 0)], np.nan)


@dataclass(frozen=True)
class Halves:
    """A rest in two halves, `fold` (n,) 0 and 1: what is read in one is tried in the other."""

    rest: Rest
    fold: Array

    @cached_property
    def alone(self) -> tuple[Array, Array]:
        """What is left of every row without any coordinate, (n,) each, from the rows that are not in the fold: with
        zeros and the baseline fitted to them, or with zeros alone where that does better.
        """
        return self._alone(0), self._alone(1)

    def _alone(self, test: int) -> Array:
        r, seen = self.rest, self.fold == test
        still = replace(r, z=r.z[:, :0], known=r.known[:0, :0])
        left = [x.e - beside(x, ~seen).of(x) for x in (r, still)]
        return min(left, key=lambda e: float(e[seen] @ e[seen]))

    @cached_property
    def total(self) -> float:
        """Mean square beyond the floor's."""
        return max(float(np.mean(self.rest.e**2)) - 1.0, LEAST)


def folds(r: Rest) -> Array:
    """0 and 1 in turn, stretches of 2 s: long against correlation, short against everything that drifts."""
    return np.asarray((r.at["time"] // 2.0).astype(int) % 2)


def beside(r: Rest, rows: Rows) -> Beside:
    """Least squares over `rows` (n,) without any bins."""
    return binned(r, np.full(r.e.size, -1), rows).beside


def binned(r: Rest, index: Index, rows: Rows) -> Binned:
    """Least squares over `rows` (n,) that lie in a bin, all of them when none does: normal equations of zeros and
    baseline, the bins solved away."""
    size = max(int(index.max(initial=0)) + 1, 1)
    inside = rows & (index >= 0)
    often = np.bincount(index[inside], minlength=size) >= FEWEST
    inside &= often[np.maximum(index, 0)]
    fitted = np.flatnonzero(inside if inside.any() else rows)
    runs, run = np.unique(r.run, return_inverse=True)
    own = (run[fitted], runs.size) if r.own_zeros else (np.zeros(0, int), 0)
    s = _sums(np.column_stack([r.z[fitted], r.e[fitted]]), own, np.where(inside, index, size)[fitted], size)
    share = s.by_bin / np.maximum(s.count, 1.0)[:, None]
    normal = s.normal - share.T @ s.by_bin
    normal[own[1] :, own[1] :] += r.known * fitted.size
    x = solved(normal, s.right - share.T @ s.total)
    values = np.where(often, (s.total - s.by_bin @ x) / np.maximum(s.count, 1.0), np.nan)
    zeros = x[: own[1]] if r.own_zeros else np.zeros(runs.size)
    return Binned(values, Beside(runs, zeros, x[own[1] :]))


@dataclass(frozen=True)
class _Sums:
    """Of what stands beside the bins: normal matrix (k, k), right side (k,); by bin its columns (b, k), the rest (b,)
    and the rows (b,)."""

    normal: Array
    right: Array
    by_bin: Array
    total: Array
    count: Array


def _sums(ze: Array, own: tuple[Index, int], at: Index, size: int) -> _Sums:
    """`ze`: columns of the baseline and the rest last; `own`: run of each row and how many; a bin `size` is none."""
    run, runs = own
    z, e = ze[:, :-1], ze[:, -1]
    wide = np.column_stack([ze, np.ones(e.size)])
    cells = _ones(at, size + 1, e.size)
    by_bin = cells @ wide
    by_run = _ones(run, runs, e.size) @ wide if runs else np.zeros((0, wide.shape[1]))
    table = np.bincount(at * runs + run, minlength=(size + 1) * runs) if runs else np.zeros(0)
    table = table.reshape(size + 1, runs).astype(float)
    normal = np.block([[np.diag(by_run[:, -1]), by_run[:, :-2]], [by_run[:, :-2].T, z.T @ z]])
    right = np.concatenate([by_run[:, -2], z.T @ e])
    columns = np.hstack([table, by_bin[:, :-2]])
    return _Sums(normal, right, columns[:size], by_bin[:size, -2], by_bin[:size, -1])


def _ones(at: Index, size: int, rows: int) -> csr_matrix:
    """Adds up rows by where they are, (size, rows)."""
    return csr_matrix((np.ones(rows), (at, np.arange(rows))), shape=(size, rows))


def solved(normal: Array, right: Array) -> Array:
    """Coefficients (k,) from a normal matrix (k, k) and its right side (k,); those of columns that the bins leave
    nothing of stay at zero."""
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-12))
    held = normal / scale / scale[:, None] + EVEN * np.eye(right.size)
    return np.asarray(np.linalg.solve(held, right / scale) / scale)


def score(h: Halves, index: Index) -> float:
    """Mean square that bins of one fold explain in the other, beyond what zeros and baseline alone do; rows in no bin,
    or in one that the fold did not show, are left out."""
    r, gain = h.rest, 0.0
    for test in (0, 1):
        found = binned(r, index, h.fold != test)
        guess = found.guess(index)
        seen = (h.fold == test) & np.isfinite(guess)
        before = h.alone[test][seen]
        after = (r.e - guess - found.beside.of(r))[seen]
        gain += float(before @ before - after @ after)
    return gain / max(r.e.size, 1)
