"""What the mean of θ̃ does from revolution to revolution: with the output angle, with the direction, with time."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rig.analysis.angle import DEG, TURN
from rig.analysis.intervals import inflation, neighbour_correlation, t95
from rig.analysis.result import Array
from rig.analysis.revolutions import StrokeResult
from rig.analysis.sums import legendre


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
    mean = np.concatenate([s.mean for s in strokes])
    theta_l = np.concatenate([s.theta_l for s in strokes])
    middle = np.concatenate([s.middle for s in strokes])
    sign = np.concatenate([np.full(s.mean.size, float(s.direction)) for s in strokes])
    both = bool(np.any(sign > 0) and np.any(sign < 0))
    half_turn = 0.5 * TURN / ratio
    low, high = float(theta_l.min()) - half_turn, float(theta_l.max()) + half_turn
    covered = (high - low) * DEG
    n = mean.size
    longest = max(s.mean.size for s in strokes)
    degree = min(max(longest // 2, 1), 3) if longest < 12 else min(longest // 4, 12)
    extra = int(both) + int(both and timed)
    degree = min(degree, n - extra - 3)
    if degree < 1:
        return Trend(None, None, covered, None, None)

    def shape(angle: Array) -> Array:
        return legendre(2.0 * (angle - low) / (high - low) - 1.0, degree)

    columns = [*shape(theta_l)]
    if both:
        columns.append(sign)
        if timed:
            columns.append((middle - middle.mean()) / 60.0)
    design = np.column_stack(columns)
    origin = float(mean.mean())
    coefficients: Array
    coefficients, _, rank, _ = np.linalg.lstsq(design, mean - origin, rcond=1e-10)
    rest = mean - origin - design @ coefficients
    dof = n - int(rank)
    if rank < design.shape[1] or dof < 1:
        return Trend(None, None, covered, None, None)
    starts = np.cumsum([0, *(s.mean.size for s in strokes)])
    widen = inflation(neighbour_correlation([rest[a:b, None] for a, b in pairwise(map(int, starts))]))
    covariance = np.linalg.inv(design.T @ design) * (float(rest @ rest) / dof * widen)
    factor = t95(dof / widen)

    def half_width(row: Array) -> float:
        return factor * float(np.sqrt(max(float(row @ covariance @ row), 0.0)))

    grid = np.linspace(low, high, 181)
    curve = shape(grid)
    slow = np.vstack((np.zeros(curve.shape[1]), curve[1:], np.zeros((extra, curve.shape[1])))).T  # less its constant
    values = slow @ coefficients
    # the mean slope over what was covered, ends to ends by a line through the polynomial
    line = np.polynomial.polynomial.polyfit(grid * DEG, slow, 1)[1]
    extremes = slow[int(np.argmax(values))] - slow[int(np.argmin(values))]
    offset_row, drift_row = np.zeros(design.shape[1]), np.zeros(design.shape[1])
    if both:
        offset_row[degree + 1] = 1.0
        if timed:
            drift_row[degree + 2] = 1.0

    def figure(row: Array) -> tuple[float, float]:
        return float(row @ coefficients), half_width(row)

    return Trend(
        slope=figure(line),
        peak_to_peak=(float(np.ptp(values)), half_width(extremes)),
        covered_deg=covered,
        offset=figure(offset_row) if both else None,
        drift=figure(drift_row) if both and timed else None,
    )
