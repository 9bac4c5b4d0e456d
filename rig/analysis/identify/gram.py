"""Normal equations that add up: rows of several runs, each with its own noise, and what each run alone says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.identify.solve import Solved
from rig.core.quantiles import Z95

Complex = npt.NDArray[np.complex128]
BAND = 2  # orders on either side whose noise is taken as the same: one run has few windows, its noise is smooth
PASSES = 4  # solve, take the noise from what is left, solve again
SURE = 3.0  # standard errors by which runs must disagree before intervals are widened for it
ENOUGH = 30  # independent windows: their scatter is then good to an eighth of itself
MANY = 1e9  # degrees of freedom: the normal law
FLOOR = 1e-12  # of the rows' own mean square: noise is never taken as less (noiseless data)


@dataclass(frozen=True)
class Rows:
    """One stretch's equations at its orders, phasors: X (W, n, p), y (W, n); variance of W windows `inflation` up."""

    stretch: str
    X: Complex
    y: Complex
    inflation: float


@dataclass(frozen=True)
class Known:
    """Rows already reduced to normal equations, from elsewhere: a lock test, a slow run, a measured friction."""

    run: str
    H: Array  # (p, p) Σ x·xᵀ/σ²
    g: Array  # (p,) Σ x·y/σ²


def known(run: str, X: Array, y: Array, variance: Array | float) -> Known:
    """Real rows X (n, p), y (n,) of the given variance."""
    w = 1.0 / np.broadcast_to(np.asarray(variance, dtype=np.float64), y.shape)
    return Known(run, (X * w[:, None]).T @ X, (X * w[:, None]).T @ y)


def solve(rows: Sequence[Rows], fixed: Sequence[Known], size: int) -> Solved | None:
    """Least squares over all rows; each run's noise from its own residuals, band by band. None without enough rows.

    Runs that disagree by more than chance allows widen every interval they disagree on (Birge's ratio, per
    coefficient): a model that lacks something is not more certain for having been asked often.
    """
    if not rows and not fixed:
        return None
    noise = [np.full(r.y.shape[1], max(float(np.mean(np.abs(r.y) ** 2)), 1e-300)) for r in rows]
    c, parts = np.zeros(size), [*fixed]
    H = np.zeros((size, size))
    for _ in range(PASSES):
        parts = [*fixed, *(_reduced(r, v) for r, v in zip(rows, noise, strict=True))]
        H, g = sum((k.H for k in parts), np.zeros((size, size))), sum((k.g for k in parts), np.zeros(size))
        c = _inverse(H) @ g
        noise = [_noise(r, c, size, len(rows)) for r in rows]
    covariance = _inverse(H)
    birge = _disagreement(parts, c, covariance)
    count = sum(2.0 * r.y.size / r.inflation for r in rows) + 30.0 * len(fixed)
    influence = {r.stretch: _influence(r, v, c, covariance) for r, v in zip(rows, noise, strict=True)}
    each, all_ = _contributions(covariance, fixed, rows, influence)
    few = _student(each, all_, rows) * np.sqrt(_guessed(each / np.maximum(all_, 1e-300), rows))
    scale = np.sqrt(birge * _seen(covariance, all_, rows)) * few
    influence = {stretch: i * few for stretch, i in influence.items()}  # two fits share what is in the covariance
    widened = covariance * np.outer(scale, scale)
    return Solved(c, widened, max(count - size, 1.0), 0.0, float(np.sqrt(np.max(birge))), influence)


def _inverse(H: Array) -> Array:
    scale = np.sqrt(np.maximum(np.diag(H), 1e-300))
    inner = np.linalg.pinv(H / np.outer(scale, scale), rcond=1e-13, hermitian=True)
    return np.asarray(inner / np.outer(scale, scale))


def _reduced(rows: Rows, noise: Array) -> Known:
    """The mean of all windows, order by order: noise in the columns, which biases, is down by their number with it.

    σ² = E|r|² of a phasor row is half in each of its parts.
    """
    X, y = rows.X.mean(axis=0), rows.y.mean(axis=0)
    w = 2.0 * rows.y.shape[0] / (noise * rows.inflation)
    weighted = (np.conj(X) * w[:, None]).T
    return Known(rows.stretch, (weighted @ X).real, (weighted @ y).real)


def _contributions(
    covariance: Array, fixed: Sequence[Known], rows: Sequence[Rows], influence: Mapping[str, Array]
) -> tuple[Array, Array]:
    """Variance of each coefficient as the windows scatter: by stretch (R, p), and of all, with what is known, (p,)."""
    each = np.array([np.sum(influence[r.stretch] ** 2, axis=0) for r in rows]).reshape(len(rows), covariance.shape[0])
    known = sum((np.einsum("ij,jk,ki->i", covariance, k.H, covariance) for k in fixed), np.zeros(covariance.shape[0]))
    return each, each.sum(axis=0) + known


def _seen(covariance: Array, scatter: Array, rows: Sequence[Rows]) -> Array:
    """(p,) variance of each coefficient as the windows scatter, over what the noise of the orders says.

    The noise of an order is pooled with that of its neighbours, and orders in one window are not independent: the
    windows, which are, say what both come to      [liang1986]. Believed where there are enough of them.
    """
    windows = sum(max(r.y.shape[0] / r.inflation - 1.0, 0.0) for r in rows)
    ratio = scatter / np.maximum(np.diag(covariance), 1e-300)
    return np.asarray(ratio if windows >= ENOUGH else np.maximum(ratio, 1.0))


def _student(each: Array, all_: Array, rows: Sequence[Rows]) -> Array:
    """(p,) by how much Student's factor is above that of the normal law, for as few windows as speak of a coefficient.

    Effective degrees of freedom of Welch and Satterthwaite over the stretches; rows already reduced have their own
    factor in their variance      [gum, G.4]
    """
    dof = np.array([max(r.y.shape[0] / r.inflation - 1.0, 1.0) for r in rows])[:, None]
    effective = all_**2 / np.maximum(np.sum(each**2 / dof, axis=0), 1e-300)
    return np.array([t95(min(nu, MANY)) / Z95 for nu in effective])


def _guessed(share: Array, rows: Sequence[Rows]) -> Array:
    """(p,) by how much the variance is larger because the stretches are weighted by noise taken from their own scatter.

    1 + 4·Σ f·(1 − f)/ν, with f = `share` (R, p) of a stretch in the variance and ν degrees of freedom behind its noise:
    two parts of every independent window, at the orders it is pooled over      [meier1953]
    """
    pooled = np.array([min(2 * BAND + 1, r.y.shape[1]) for r in rows], dtype=np.float64)
    free = np.array([max(r.y.shape[0] / r.inflation - 1.0, 0.5) for r in rows])
    return np.asarray(1.0 + 4.0 * np.sum(share * (1.0 - share) / (2.0 * pooled * free)[:, None], axis=0))


def _influence(rows: Rows, noise: Array, c: Array, covariance: Array) -> Array:
    """(W, p): what each window's own residuals, about those of its stretch, did to the coefficients (see Solved).

    W windows that overlap have W/`inflation` means to be off by, and the mean of the stretch takes one of them.
    """
    windows = rows.y.shape[0]
    left = rows.y - rows.X @ c
    left = left - left.mean(axis=0)
    weighted = np.conj(rows.X.mean(axis=0)) * (2.0 / (noise * rows.inflation))[:, None]
    scale = np.sqrt(rows.inflation / max(1.0 - rows.inflation / windows, 1.0 / windows))
    return np.asarray(scale * (left @ weighted).real @ covariance)


def _noise(rows: Rows, c: Array, size: int, runs: int) -> Array:
    """E|r|² of each order (n,), over the windows and the orders beside it."""
    power = np.mean(np.abs(rows.y - rows.X @ c) ** 2, axis=0)
    pooled = np.array([np.mean(power[max(i - BAND, 0) : i + BAND + 1]) for i in range(power.size)])
    free = 1.0 - size * rows.inflation / max(2.0 * rows.y.size * runs, 1.0)
    least = FLOOR * float(np.mean(np.abs(rows.y) ** 2))
    return np.asarray(np.maximum(pooled / max(free, 0.5), max(least, 1e-300)))


def _disagreement(parts: Sequence[Known], c: Array, covariance: Array) -> Array:
    """(p,) factor ≥ 1 on each coefficient's variance: scatter of what the runs alone say, over what is expected."""
    size = c.size
    total, expected, count = np.zeros(size), np.zeros(size), np.zeros(size)
    for part in parts:
        pulled, own = covariance @ (part.g - part.H @ c), np.diag(covariance @ part.H @ covariance)
        share = own / np.maximum(np.diag(covariance), 1e-300)  # of the coefficient's information that this run gave
        counts = share > 0.02
        total += np.where(counts, pulled**2 / np.maximum(own, 1e-300), 0.0)
        expected += np.where(counts, np.maximum(1.0 - share, 0.0), 0.0)
        count += counts
    ratio = total / np.maximum(expected, 1e-300)
    limit = 1.0 + SURE * np.sqrt(2.0 / np.maximum(expected, 1.0))
    return np.where((count >= 3) & (ratio > limit), ratio, 1.0)
