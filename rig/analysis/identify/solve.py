"""Weighted least squares with honest intervals: scatter between runs that the scatter within them does not explain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.intervals import t95
from rig.analysis.result import Array

ENOUGH = 8  # degrees of freedom from which the scatter of the rows is believed against their own variances
HALVINGS = 60  # of the between-run variance: to the last digits


@dataclass(frozen=True)
class Solved:
    """Coefficients (p,) with covariance (p, p); `dof` behind it; `between` 1 σ between rows, beyond their own."""

    coefficients: Array
    covariance: Array
    dof: float
    between: float
    pull: float  # rms of the residuals in their own σ, before `between` was added

    def u(self, i: int) -> float:
        """1 σ of a coefficient."""
        return float(np.sqrt(max(self.covariance[i, i], 0.0)))

    def half(self, i: int) -> float:
        """Half the 95 % interval of a coefficient."""
        return t95(self.dof) * self.u(i)


def weighted(X: Array, y: Array, variance: Array) -> tuple[Array, Array]:
    """Coefficients and their covariance for rows `X` (n, p), `y` (n,) of the given variances; columns are scaled."""
    w = 1.0 / np.sqrt(variance)
    A, b = X * w[:, None], y * w
    scale = np.sqrt(np.maximum(np.sum(A * A, axis=0), 1e-300))
    inverse = np.linalg.pinv((A / scale).T @ (A / scale), rcond=1e-12, hermitian=True)
    coefficients = inverse @ ((A / scale).T @ b) / scale
    return np.asarray(coefficients), np.asarray(inverse / np.outer(scale, scale))


def random_effects(X: Array, y: Array, variance: Array) -> Solved:
    """Rows whose scatter is `variance` each, (n,), plus one variance between rows chosen so that χ² is what it should.

    The estimator of Paule and Mandel: runs repeat less well than one run's own scatter says, because a zero, a
    temperature or a lubricant film changed between them      [paule1982]. Where they repeat better than that, the rows'
    variance was taken too large and is scaled down, given enough of them to tell.
    """
    n, p = X.shape
    dof = n - p

    def chi2(extra: float) -> float:
        c, _ = weighted(X, y, variance + extra)
        return float(np.sum((y - X @ c) ** 2 / (variance + extra)))

    low, high = 0.0, float(np.var(y - X @ weighted(X, y, variance)[0]) * n / max(dof, 1)) * 4 + 1e-30
    if dof < 1 or chi2(0.0) <= dof:
        high = 0.0
    for _ in range(HALVINGS if high else 0):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if chi2(middle) > dof else (low, middle)
    c, covariance = weighted(X, y, variance + high)
    pull = float(np.sqrt(chi2(0.0) / max(dof, 1)))
    if dof >= ENOUGH and pull < 1.0:
        covariance = covariance * pull**2
    return Solved(c, covariance, max(dof, 1), float(np.sqrt(high)), pull)
