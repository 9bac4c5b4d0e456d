"""One stroke to its revolutions: the slow trend taken off, Fourier coefficients and a curve for each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.motion.strokes import Stroke
from rig.analysis.orders.sums import BLOCK, Sums, harmonics, legendre
from rig.core.units import TURN

GRID = 512  # points per motor turn of the curves
ROWS_PER_TERM = 4  # rows a revolution must have for each order: twice what Nyquist asks, the rows are not evenly spaced


@dataclass(frozen=True)
class StrokeResult:
    """What the whole revolutions of one stroke say; R revolutions, k orders, G grid points; arcsec at the output."""

    direction: int
    cosine: Array  # (R, k) a_n of each revolution
    sine: Array  # (R, k) b_n
    mean: Array  # (R,) mean of θ̃ over each revolution, trend included
    theta_l: Array  # (R,) rad, where on the output each revolution lies
    middle: Array  # (R,) s, when; row numbers without time
    speed_rpm: Array  # (R,) signed; NaN without time
    total: Array  # (G,) sum of θ̃ less trend and stroke mean, over the rows in each bin
    position: Array  # (G,) sum of the rows' place in the turn, 0..1
    rows: Array  # (G,) rows in each bin
    curves: Array  # (R, G) the same, each revolution by itself
    residual_square: Array  # (R,) arcsec², Σ over the rows of each revolution of what no term explains
    residual_rows: Array  # (R,)
    trend: Array  # Legendre coefficients over the stroke, arcsec, constant included


def trend_degree(span: float, revolutions: int) -> int:
    """Degree of the slow change a stroke of `span` turns may have taken off: a cubic at 6 turns, never faster.

    Eccentricity of the output bends θ̃ over the stroke; a polynomial this slow takes it off and leaves order 1 alone.
    """
    if revolutions >= 12:
        return min(revolutions // 4, 24)
    if revolutions >= 2:
        return min(revolutions // 2, 3)
    return 1 if span >= 1.25 else 0  # one turn cannot tell a slope from its own sine terms; a turn and a quarter can


def filled(total: Array, position: Array, rows: Array) -> Array:
    """Bin means moved from where the rows lay to the middle of each bin; empty bins from their neighbours."""
    here = rows > 0
    return np.interp(_middles(rows.size), position[here] / rows[here], total[here] / rows[here], period=1.0)


def _of_one(one: tuple[Array, Array, Array], beyond: Sequence[tuple[float, float]]) -> Array:
    """The same of one revolution, whose end need not meet its beginning: between its outermost bins and the rows
    `beyond` them (place in turns of this one, below 0 or above 1; value) it is a straight line."""
    total, position, rows = one
    here = rows > 0
    before, after = ([end for end in beyond if (end[0] < 0.0) is is_before] for is_before in (True, False))
    inner = np.stack([position[here] / rows[here], total[here] / rows[here]], 1)
    place, value = np.concatenate([np.array(before).reshape(-1, 2), inner, np.array(after).reshape(-1, 2)]).T
    return np.asarray(np.interp(_middles(rows.size), place, value))


def _middles(bins: int) -> Array:
    return np.asarray((np.arange(bins) + 0.5) / bins)


def _in_bins(theta: Array, y: Array) -> tuple[Array, Array, Array]:
    place = (theta / TURN) % 1.0
    bins = np.minimum((place * GRID).astype(np.int64), GRID - 1)
    return (
        np.asarray(np.bincount(bins, y, GRID), dtype=np.float64),
        np.asarray(np.bincount(bins, place, GRID), dtype=np.float64),
        np.asarray(np.bincount(bins, minlength=GRID), dtype=np.float64),
    )


def _curves(
    motion: Motion, edges: list[int], cleaned: Callable[[Array, Array], Array]
) -> tuple[Array, tuple[Array, Array, Array]]:
    """Each revolution's profile (R, GRID), and the sums of all of them per bin; `cleaned` takes the trend off."""
    curves = np.empty((len(edges) - 1, GRID))
    total, position, rows = np.zeros(GRID), np.zeros(GRID), np.zeros(GRID)
    for r, (a, b) in enumerate(pairwise(edges)):
        first, last = max(a - 1, 0), min(b + 1, motion.theta_m.size)
        theta = motion.theta_m[first:last]
        value = cleaned(theta, motion.error_arcsec(first, last))
        inner = slice(a - first, b - first)
        one = _in_bins(theta[inner], value[inner])
        place = theta / TURN - np.floor(theta[theta.size // 2] / TURN)
        ends = [(float(place[i]), float(value[i])) for i in (0, -1) if not 0.0 <= place[i] < 1.0]
        curves[r] = _of_one(one, ends)
        total, position, rows = total + one[0], position + one[1], rows + one[2]
    return curves, (total, position, rows)


def _each(pieces: list[Sums], trend: Array, degree: int, order0: list[int]) -> tuple[Array, Array]:
    """Coefficients of every revolution less the stroke's trend, (R, 1 + 2·terms), and what is left, (R,)."""
    slow = slice(1, degree + 1)
    coefficients, residual_square = np.empty((len(pieces), len(order0))), np.empty(len(pieces))
    for r, piece in enumerate(pieces):
        moment = piece.moment - piece.gram[:, slow] @ trend[1:]
        square = piece.square - 2.0 * float(trend[1:] @ piece.moment[slow])
        square += float(trend[1:] @ piece.gram[slow, slow] @ trend[1:])
        own = Sums(piece.gram[np.ix_(order0, order0)], moment[order0], square, piece.count)
        coefficients[r] = own.solve()
        residual_square[r] = own.residual(coefficients[r])
    return coefficients, residual_square


@dataclass(frozen=True)
class _Fit:
    """What is fitted to a stroke: a slow trend of Legendre polynomials up to `degree`, and `terms` orders."""

    motion: Motion
    base: float  # rad, the motor's angle at the stroke's start
    span: float  # rad, half of how far it turns
    zero: float  # arcsec, taken off θ̃: keeps the sums small, only differences matter
    degree: int
    terms: int
    room: Array  # for the columns of every block: fresh memory would cost as much as they do

    @staticmethod
    def of(motion: Motion, stroke: Stroke, terms: int) -> _Fit:
        base, span = (
            motion.theta_m[stroke.start],
            0.5 * (motion.theta_m[stroke.stop - 1] - motion.theta_m[stroke.start]),
        )
        degree = trend_degree(2 * abs(float(span)) / TURN, stroke.revolutions)
        first = int(stroke.edges[0])
        zero, room = motion.error_arcsec(first, first + 1)[0], np.empty((degree + 1 + 2 * terms, BLOCK))
        return _Fit(motion, base, span, float(zero), degree, terms, room)

    @property
    def orders(self) -> range:
        """Columns of the orders, after those of the trend."""
        return range(self.degree + 1, self.degree + 1 + 2 * self.terms)

    def slow_columns(self, theta: Array) -> Array:
        """Legendre polynomials (degree + 1, n) at those angles of the motor."""
        return legendre((theta - self.base) / self.span - 1.0, self.degree)

    def sums(self, lo: int, hi: int) -> Sums:
        """Of rows lo..hi, block by block."""
        size = len(self.room)
        total = Sums(np.zeros((size, size)), np.zeros(size), 0.0, 0)
        for a in range(lo, hi, BLOCK):
            b = min(a + BLOCK, hi)
            theta = self.motion.theta_m[a:b]
            columns = self.room[:, : b - a]
            columns[: self.orders.start] = self.slow_columns(theta)
            harmonics(theta, self.terms, columns[self.orders.start :])
            total = total + Sums.of(columns, self.motion.error_arcsec(a, b) - self.zero)
        return total


def analyse_stroke(motion: Motion, stroke: Stroke, terms: int) -> StrokeResult:
    """Fourier coefficients of every whole revolution, by least squares over all its rows, with one trend per stroke.

    The sums of each revolution are kept: the trend is solved from their total, the revolutions from their own, so the
    rows are read once for the numbers and once for the curves.
    """
    fit, edges = _Fit.of(motion, stroke, terms), [int(e) for e in stroke.edges]
    pieces = [fit.sums(a, b) for a, b in pairwise(edges)]
    whole = sum(pieces[1:], start=pieces[0])
    if stroke.revolutions == 1:
        whole = whole + fit.sums(stroke.start, edges[0]) + fit.sums(edges[-1], stroke.stop)
    trend = whole.solve()[: fit.degree + 1]
    coefficients, residual_square = _each(pieces, trend, fit.degree, [0, *fit.orders])
    slow_mean = np.array([p.gram[0, 1 : fit.degree + 1] @ trend[1:] / max(p.count, 1) for p in pieces])
    curves, (total, position, rows) = _curves(
        motion, edges, lambda theta, error: error - fit.zero - trend @ fit.slow_columns(theta)
    )
    theta_l = motion.theta_l
    assert theta_l is not None
    middle = np.array([(a + b) // 2 for a, b in pairwise(edges)])
    return StrokeResult(
        direction=stroke.direction,
        cosine=coefficients[:, 1 : 1 + terms],
        sine=coefficients[:, 1 + terms :],
        mean=coefficients[:, 0] + slow_mean + fit.zero,
        theta_l=theta_l[middle],
        middle=middle.astype(np.float64) if motion.t is None else motion.t[middle],
        speed_rpm=np.array([motion.speed_rpm(a, b) for a, b in pairwise(edges)]),
        total=total,
        position=position,
        rows=rows,
        curves=curves,
        residual_square=residual_square,
        residual_rows=np.array([piece.count for piece in pieces], dtype=np.float64),
        trend=trend,
    )
