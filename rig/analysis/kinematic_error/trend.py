"""What the mean of θ̃ does from revolution to revolution: with the output angle, with the direction, with time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rig.analysis.findings.intervals import inflation, neighbour_correlation, t95
from rig.analysis.findings.result import Array
from rig.analysis.orders.revolutions import StrokeResult
from rig.analysis.orders.sums import legendre
from rig.core.units import DEG, TURN


@dataclass(frozen=True)
class Trend:
    """Slow change of θ̃, arcsec. Each figure is (value, half width of its 95 % interval); None: this run cannot tell."""

    slope: tuple[float, float] | None  # arcsec per degree of the output, of the part that follows the output angle
    peak_to_peak: tuple[float, float] | None  # arcsec, of that part over the output angle covered
    covered_deg: float  # output angle covered
    offset: tuple[float, float] | None  # arcsec, half of forward minus reverse mean at equal output angle
    drift: tuple[float, float] | None  # arcsec per minute, of the part that follows time


def find_trend(strokes: list[StrokeResult], ratio: float, timed: bool) -> Trend:
    """Split the revolutions' means into output angle (a polynomial), direction (±) and time (a line), by least squares.

    Going back over the same angles is what separates geometry from drift, so with one direction the whole trend is
    given as one and the drift as unknown. Too few revolutions: all None.
    """
    theta_l = np.concatenate([s.theta_l for s in strokes])
    middle = np.concatenate([s.middle for s in strokes])
    sign = np.concatenate([np.full(s.mean.size, float(s.direction)) for s in strokes])
    both = bool(np.any(sign > 0) and np.any(sign < 0))
    half_turn = 0.5 * TURN / ratio
    low, high = float(theta_l.min()) - half_turn, float(theta_l.max()) + half_turn
    extra = [sign] if both else []
    if both and timed:
        extra.append((middle - middle.mean()) / 60.0)
    degree = min(_degree(max(s.mean.size for s in strokes)), theta_l.size - len(extra) - 3)
    shape = _shape(low, high, max(degree, 1))
    fit = _fit(strokes, np.column_stack([*shape(theta_l), *extra])) if degree >= 1 else None
    if fit is None:
        return Trend(None, None, (high - low) / DEG, None, None)
    grid = np.linspace(low, high, 181)
    curve = shape(grid)
    slow = np.vstack(
        (np.zeros(curve.shape[1]), curve[1:], np.zeros((len(extra), curve.shape[1])))
    ).T  # less its constant
    values = slow @ fit.coefficients
    # the mean slope over what was covered, ends to ends by a line through the polynomial
    line = np.polynomial.polynomial.polyfit(grid / DEG, slow, 1)[1]
    extremes = slow[int(np.argmax(values))] - slow[int(np.argmin(values))]
    alone = np.eye(fit.coefficients.size)[degree + 1 :]  # direction, then time
    return Trend(
        slope=fit.figure(line),
        peak_to_peak=(float(np.ptp(values)), fit.figure(extremes)[1]),
        covered_deg=(high - low) / DEG,
        offset=fit.figure(alone[0]) if both else None,
        drift=fit.figure(alone[1]) if both and timed else None,
    )


@dataclass(frozen=True)
class _Fit:
    """Least-squares coefficients with their covariance."""

    coefficients: Array
    covariance: Array
    factor: float  # 95 %, one figure

    def figure(self, row: Array) -> tuple[float, float]:
        """Value and half width of the 95 % interval of a combination of the coefficients."""
        variance = max(float(row @ self.covariance @ row), 0.0)
        return float(row @ self.coefficients), self.factor * float(np.sqrt(variance))


def _fit(strokes: list[StrokeResult], design: Array) -> _Fit | None:
    """The revolutions' means on the columns of `design`; None when they do not settle it."""
    mean = np.concatenate([s.mean for s in strokes])
    origin = float(mean.mean())
    solved, _, rank, _ = np.linalg.lstsq(design, mean - origin, rcond=1e-10)
    coefficients = np.asarray(solved, dtype=np.float64)
    rest = mean - origin - design @ coefficients
    dof = mean.size - int(rank)
    if rank < design.shape[1] or dof < 1:
        return None
    starts = np.cumsum([0, *(s.mean.size for s in strokes)])
    widen = inflation(neighbour_correlation([rest[a:b, None] for a, b in pairwise(map(int, starts))]))
    covariance = np.asarray(np.linalg.inv(design.T @ design), dtype=np.float64) * (float(rest @ rest) / dof * widen)
    return _Fit(coefficients, covariance, t95(dof / widen))


def _degree(longest: int) -> int:
    """Of the polynomial in the output angle, for a longest stroke of so many revolutions."""
    return min(max(longest // 2, 1), 3) if longest < 12 else min(longest // 4, 12)


def _shape(low: float, high: float, degree: int) -> Callable[[Array], Array]:
    return lambda angle: legendre(2.0 * (angle - low) / (high - low) - 1.0, degree)
