"""Least squares from sums: rows are visited once, in blocks, and the memory does not grow with their number."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array

BLOCK = 8000  # rows at a time: 40 columns of them (2.6 MB) stay in the cache; no power of two (tests/bench/rows/fit.py)


@dataclass
class Sums:
    """The normal equations of y ≈ columnsᵀ·c: everything a linear fit needs, and two of them add up."""

    gram: Array  # (p, p)
    moment: Array  # (p,)
    square: float  # Σ y²
    count: int

    @classmethod
    def of(cls, columns: Array, y: Array) -> Sums:
        """`columns`: (p, n), `y`: (n,), in one unit."""
        return cls(columns @ columns.T, columns @ y, float(y @ y), y.size)

    def __add__(self, other: Sums) -> Sums:
        return Sums(
            self.gram + other.gram, self.moment + other.moment, self.square + other.square, self.count + other.count
        )

    def solve(self) -> Array:
        """The coefficients (p,). Columns that the rows cannot tell apart share their part (minimum norm)."""
        scale = np.sqrt(np.maximum(np.diag(self.gram), 1e-300))
        coefficients = np.linalg.lstsq(self.gram / np.outer(scale, scale), self.moment / scale, rcond=1e-12)[0]
        return np.asarray(coefficients / scale)

    def residual(self, coefficients: Array) -> float:
        """Σ (y − columnsᵀ·c)², never below zero."""
        explained = 2.0 * float(coefficients @ self.moment) - float(coefficients @ self.gram @ coefficients)
        return max(self.square - explained, 0.0)


def fit(columns: Callable[[int, int], Array], y: Array) -> Array:
    """Coefficients (p,) of y ≈ columnsᵀ·c; `columns(lo, hi)` gives the columns (p, hi − lo) of those rows."""
    total: Sums | None = None
    for lo in range(0, y.size, BLOCK):
        part = Sums.of(columns(lo, min(lo + BLOCK, y.size)), y[lo : lo + BLOCK])
        total = part if total is None else total + part
    return np.empty(0) if total is None else total.solve()


def without(columns: Callable[[int, int], Array], y: Array, coefficients: Array) -> Array:
    """y − columnsᵀ·c, shape (n,)."""
    out = np.empty_like(y)
    for lo in range(0, y.size, BLOCK):
        out[lo : lo + BLOCK] = y[lo : lo + BLOCK] - coefficients @ columns(lo, min(lo + BLOCK, y.size))
    return out


def harmonics(theta: Array, orders: int, out: Array | None = None) -> Array:
    """cos nθ for n = 1..orders, then sin nθ: shape (2·orders, n), into `out` where there is one.

    One exponential, then products: 10 times faster. Their complex numbers never leave the cache.
    """
    found = np.empty((2 * orders, theta.size)) if out is None else out
    z = np.exp(1j * theta)
    power = z.copy()
    for n in range(orders):
        if n:
            power *= z
        found[n], found[orders + n] = power.real, power.imag
    return found


def legendre(u: Array, degree: int) -> Array:
    """Legendre polynomials P_0..P_degree at `u` in −1..1: shape (degree + 1, n)."""
    out = np.empty((degree + 1, u.size))
    out[0] = 1.0
    if degree:
        out[1] = u
    for n in range(1, degree):
        out[n + 1] = ((2 * n + 1) * u * out[n] - n * out[n - 1]) / (n + 1)
    return out
