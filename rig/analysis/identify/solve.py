"""Weighted least squares with honest intervals: scatter between runs that the scatter within them does not explain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array

ENOUGH = 8  # degrees of freedom from which the scatter of the rows is believed against their own variances
SURE = 1.645  # standard deviations by which χ² must exceed its mean, 1 case in 20 by chance
HALVINGS = 60  # of the between-run variance: to the last digits


@dataclass(frozen=True)
class Solved:
    """Coefficients (p,) with covariance (p, p); `dof` behind it; `between` 1 σ between rows, beyond their own.

    `influence`: for every stretch what the noise of each of its windows did to the coefficients, (W, p), scaled so that
    Σ iᵀi is the part of the covariance that comes from these windows. Two fits from the same windows share it.
    """

    coefficients: Array
    covariance: Array
    dof: float
    between: float
    pull: float  # rms of the residuals in their own σ, before `between` was added
    influence: Mapping[str, Array] = field(default_factory=dict, repr=False)

    def u(self, i: int) -> float:
        """1 σ of a coefficient."""
        return float(np.sqrt(max(self.covariance[i, i], 0.0)))

    def half(self, i: int) -> float:
        """Half the 95 % interval of a coefficient."""
        return t95(self.dof) * self.u(i)


def covariance_between(a: Solved, b: Solved) -> Array:
    """(p_a, p_b): covariance of the coefficients of two fits through the noise of the windows both were made from.

    Correlations are those of the influences; where a fit knows its coefficients worse than its windows say, or better
    by other runs, the correlation is less by as much, so that all fits together stay positive definite.
    """
    size = a.coefficients.size, b.coefficients.size
    shared = sum((a.influence[k].T @ b.influence[k] for k in a.influence.keys() & b.influence.keys()), np.zeros(size))
    known_a, known_b = _sigmas(a), _sigmas(b)
    own_a, own_b = np.sqrt(np.diag(a.covariance)), np.sqrt(np.diag(b.covariance))
    return np.asarray(shared / np.outer(known_a, known_b) * np.outer(own_a, own_b))


def _sigmas(s: Solved) -> Array:
    """1 σ of each coefficient, the larger of what the covariance and what the windows say."""
    squares = sum((np.sum(i**2, axis=0) for i in s.influence.values()), np.zeros(s.coefficients.size))
    return np.sqrt(np.maximum(np.maximum(np.diag(s.covariance), squares), 1e-300))


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
    temperature or a lubricant film changed between them      [paule1982]. Only what chance does not allow is such a
    variance: one that is added whenever χ² is above its mean, and never taken off when it is below, makes every
    interval too wide. Within chance the rows' variance is scaled to their scatter, given enough of them to tell.
    """
    n, p = X.shape
    dof = n - p

    def chi2(extra: float) -> float:
        c, _ = weighted(X, y, variance + extra)
        return float(np.sum((y - X @ c) ** 2 / (variance + extra)))

    limit = dof + SURE * np.sqrt(2.0 * max(dof, 1))
    low, high = 0.0, float(np.var(y - X @ weighted(X, y, variance)[0]) * n / max(dof, 1)) * 4 + 1e-30
    if dof < 1 or chi2(0.0) <= limit:
        high = 0.0
    for _ in range(HALVINGS if high else 0):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if chi2(middle) > dof else (low, middle)
    c, covariance = weighted(X, y, variance + high)
    pull = float(np.sqrt(chi2(0.0) / max(dof, 1)))
    if high == 0.0 and (dof >= ENOUGH or pull > 1.0):
        covariance = covariance * pull**2
    return Solved(c, covariance, max(dof, 1), float(np.sqrt(high)), pull)
