"""The rest as a sum of two: one value a bin of some coordinate, and the zero every run has to itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.rest.joined import Index, Rest
from rig.model.effect import Array

FEWEST = 8  # rows of a bin: of fewer the mean is noise
EVEN = 1e-6  # of the rows: keeps zeros that nothing ties to each other where they are


@dataclass(frozen=True)
class Binned:
    """Values of bins (b,), zeros of runs beside them and zeros without any bins (r,), the runs in their order."""

    values: Array
    zeros: Array
    alone: Array
    runs: Array

    def guess(self, index: Index) -> Array:
        """Value of the bin of each row, 0 where there is none; (n,)."""
        inside = (index >= 0) & (index < self.values.size)
        return np.where(inside, self.values[np.where(inside, index, 0)], 0.0)

    def zero(self, run: Array) -> tuple[Array, Array]:
        """Zero of each row's run beside the bins, and without them; 0 for a run that was not fitted; (n,) each."""
        place = np.searchsorted(self.runs, run).clip(max=self.runs.size - 1)
        known = self.runs[place] == run
        return np.where(known, self.zeros[place], 0.0), np.where(known, self.alone[place], 0.0)


def binned(r: Rest, index: Index, rows: npt.NDArray[np.bool_]) -> Binned:
    """Least squares over `rows` (n,) that lie in a bin: normal equations of the zeros, the bins solved away."""
    runs, run = np.unique(r.run, return_inverse=True)
    count, size = runs.size, max(int(index.max(initial=0)) + 1, 1)
    inside = rows & (index >= 0)
    often = np.bincount(index[inside], minlength=size) >= FEWEST
    inside &= often[np.maximum(index, 0)]
    cell = run[inside] * size + index[inside]
    table = np.bincount(cell, minlength=count * size).reshape(count, size).astype(float)
    total = np.asarray(np.bincount(cell, r.e[inside], minlength=count * size), float).reshape(count, size)
    by_bin = np.asarray(np.maximum(table.sum(0), 1.0))
    zeros = _zeros(table, total, np.asarray(by_bin, float)) if r.own_zeros else np.zeros(count)
    values = np.where(often, (total.sum(0) - table.T @ zeros) / by_bin, 0.0)
    seen = np.maximum(np.bincount(run[rows], minlength=count), 1)
    alone = np.bincount(run[rows], r.e[rows], minlength=count) / seen if r.own_zeros else np.zeros(count)
    return Binned(values, zeros, alone, runs)


def _zeros(table: Array, total: Array, by_bin: Array) -> Array:
    """Of each run, (r,)."""
    share, by_run = table / by_bin, table.sum(1)
    held = EVEN * max(float(by_run.max(initial=0.0)), 1.0)
    normal = np.diag(by_run + held) - share @ table.T
    return np.asarray(np.linalg.solve(normal, total.sum(1) - share @ total.sum(0)))


def score(r: Rest, fold: Array, index: Index) -> float:
    """Mean square that bins of one fold explain in the other, beyond what zeros alone do; `index` −1 is left out."""
    gain, n = 0.0, 0
    for test in (0, 1):
        found, seen = binned(r, index, fold != test), (fold == test) & (index >= 0)
        zero, alone = found.zero(r.run[seen])
        e = r.e[seen]
        gain += float(np.sum((e - alone) ** 2 - (e - found.guess(index[seen]) - zero) ** 2))
        n += int(np.sum(fold == test))
    return gain / max(n, 1)
