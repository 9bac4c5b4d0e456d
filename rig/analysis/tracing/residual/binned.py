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

from rig.analysis.tracing.residual.joined import Index, Rest
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
        zeros = np.append(self.zeros, 0.0)  # the last of no run
        place = np.searchsorted(self.runs, r.run).clip(max=max(self.runs.size - 1, 0))
        known = np.append(self.runs, -1)[place] == r.run
        return np.asarray(np.where(known, zeros[place], 0.0) + r.z @ self.shift)


@dataclass(frozen=True)
class Binned:
    """Values of bins (b,), NaN where there were too few rows, and what stands beside them."""

    values: Array
    beside: Beside

    def guess(self, index: Index, worth: Array) -> Array:
        """Value of the bin of each row in floors of its own, NaN where there is none; (n,)."""
        inside = (index >= 0) & (index < self.values.size)
        return np.where(inside, self.values[np.where(inside, index, 0)] * worth, np.nan)


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
    def parts(self) -> tuple[tuple[Index, Rest], tuple[Index, Rest]]:
        """Rows of each fold, and the rest in them."""
        first, second = (np.flatnonzero(self.fold == half) for half in (0, 1))
        return (first, self.rest.part(first)), (second, self.rest.part(second))

    @cached_property
    def total(self) -> float:
        """Mean square beyond the floor's."""
        return max(float(np.mean(self.rest.e**2)) - 1.0, LEAST)


def own_excess(r: Rest) -> float:
    """Mean square beyond the floor's that stays beside a baseline fitted to this channel alone."""
    h = Halves(r.by_itself, folds(r))
    return float(sum(np.sum(h.alone[half][h.fold == half] ** 2) for half in (0, 1))) / max(r.e.size, 1) - 1.0


def straightened(r: Rest) -> Rest:
    """The rest beside a baseline fitted to this channel alone."""
    alone = r.by_itself
    return replace(alone, e=r.e - beside(alone, np.ones(r.e.size, dtype=np.bool_)).of(r))


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
    s = _sums(r, np.where(inside, index, size), inside if inside.any() else rows, size)
    own = r.whole.runs.size if r.own_zeros else 0
    share = s.by_bin / np.maximum(s.count, 1e-9)[:, None]
    normal = s.normal - share.T @ s.by_bin
    normal[own:, own:] += r.known * s.fitted
    x = solved(normal, s.right - share.T @ s.total)
    values = np.where(often, (s.total - s.by_bin @ x) / np.maximum(s.count, 1e-9), np.nan)
    zeros = x[:own] if r.own_zeros else np.zeros(r.whole.runs.size)
    return Binned(values, Beside(r.whole.runs, zeros, x[own:]))


@dataclass(frozen=True)
class _Sums:
    """Of what stands beside the bins: normal matrix (k, k), right side (k,); by bin its columns (b, k), the rest (b,)
    and their worth squared (b,). `fitted`: rows in all."""

    normal: Array
    right: Array
    by_bin: Array
    total: Array
    count: Array
    fitted: int


def _sums(r: Rest, at: Index, fitted: Rows, size: int) -> _Sums:
    """Over the rows `fitted`: what all rows come to, less those left out; a bin `size` is none."""
    all_of, out = r.whole, np.flatnonzero(~fitted)
    less, runs = all_of.wide[out], all_of.runs.size if r.own_zeros else 0
    gram = all_of.gram - less.T @ less
    by_bin = added(at, size + 1, r.worth) @ all_of.wide
    by_run = (all_of.by_run - added(all_of.run[out], all_of.runs.size, np.ones(out.size)) @ less)[:runs]
    crossed = np.bincount(at * runs + all_of.run, r.worth, (size + 1) * runs)[: (size + 1) * runs]
    table = crossed.reshape(size + 1, runs).astype(float)
    count = np.asarray(np.bincount(at, r.worth**2, size + 1), dtype=np.float64)
    normal = np.block([[np.diag(by_run[:, -1]), by_run[:, :-2]], [by_run[:, :-2].T, gram[:-2, :-2]]])
    right = np.concatenate([by_run[:, -2], gram[:-2, -2]])
    columns = np.hstack([table, by_bin[:, :-2]])
    return _Sums(normal, right, columns[:size], by_bin[:size, -2], count[:size], at.size - out.size)


def added(at: Index, size: int, worth: Array) -> csr_matrix:
    """Adds up rows (n,) by where they are, each as often as it is worth, (size, n)."""
    return csr_matrix((worth, (at, np.arange(at.size))), shape=(size, at.size))


def solved(normal: Array, right: Array) -> Array:
    """Coefficients (k,) or (k, m) from a normal matrix (k, k) and its right side, one or m of them; those of columns
    that the bins leave nothing of stay at zero."""
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-12))
    held = normal / scale / scale[:, None] + EVEN * np.eye(scale.size)
    return np.asarray((np.linalg.solve(held, (right.T / scale).T).T / scale).T)


def score(h: Halves, index: Index) -> float:
    """Mean square that bins of one fold explain in the other, beyond what zeros and baseline alone do; rows in no bin,
    or in one that the fold did not show, are left out."""
    gain = 0.0
    for test in (0, 1):
        (_, train), (rows, tested) = h.parts[1 - test], h.parts[test]
        found = binned(train, index[h.parts[1 - test][0]], np.ones(train.e.size, dtype=np.bool_))
        guess = found.guess(index[rows], tested.worth)
        seen = np.isfinite(guess)
        before = h.alone[test][rows][seen]
        after = (tested.e - guess - found.beside.of(tested))[seen]
        gain += float(before @ before - after @ after)
    return gain / max(h.rest.e.size, 1)
