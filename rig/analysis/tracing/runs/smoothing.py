"""One Gaussian low-pass for every reading and every column, with its derivatives; zero phase, then fewer rows.

A residual is only explained by columns that went through the same filter: filter the reading and not the columns, and
the filter itself looks like an effect.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numba import njit

from rig.model.effect import Array

WIDE = 8  # columns, which the machine adds up at once
BLOCK = 1024  # rows, which stay in the cache
REACH = 4.5  # standard deviations of the kernel kept on each side: 1e-5 of its height is cut off


@lru_cache(maxsize=64)
def kernel(sigma: float, dt: float, derivative: int) -> Array:
    """Gaussian of standard deviation `sigma` s sampled every `dt` s, its `derivative` 0..3; shape (odd,).

    Corrected so that it maps t^d/d! exactly to one, and (derivatives above 0) a constant exactly to zero.
    """
    half = int(np.ceil(REACH * sigma / dt))
    t = np.arange(-half, half + 1) * dt
    x = t / sigma
    bell = np.exp(-0.5 * x * x)
    hermite = (np.ones_like(x), -x, x * x - 1.0, -x * (x * x - 3.0))[derivative]
    taps = hermite * bell
    if derivative == 2:
        taps = taps - bell * (taps.sum() / bell.sum())
    if derivative == 3:
        odd = x * bell
        taps = taps - odd * ((taps @ t) / (odd @ t))
    power = (-t) ** derivative / float(np.prod(np.arange(1, derivative + 1)))
    return np.asarray(taps / (taps @ power))


def _in_time(sigma_hz: float) -> float:
    """Standard deviation in s of a kernel that is one of `sigma_hz` in the spectrum."""
    return float(1.0 / (2 * np.pi * sigma_hz))


@lru_cache(maxsize=64)
def _turned_round(sigma_hz: float, dt: float, derivative: int) -> Array:
    """As a correlation takes it."""
    return kernel(_in_time(sigma_hz), dt, derivative)[::-1].copy()


@njit(cache=True, nogil=True)
def _thinned(x: Array, taps: Array, m: int, step: int) -> Array:
    """Correlation of the columns of `x` (n, k) with `taps`, every `step`-th row, (m, k)."""
    out = np.zeros((m, x.shape[1]))
    for i in range(m):
        for j in range(taps.size):
            tap = taps[j]
            for k in range(x.shape[1]):
                out[i, k] += tap * x[i * step + j, k]
    return out


@njit(cache=True, nogil=True)
def _thinned_narrow(x: Array, taps: Array, m: int, step: int) -> Array:
    """As `_thinned`, of a few columns: rows of one phase side by side, so that the machine adds several at once."""
    out = np.empty((m, x.shape[1]))
    reach = (taps.size - 1) // step
    phases, sums = np.empty((step, BLOCK + reach)), np.empty(BLOCK)
    for k in range(x.shape[1]):
        for start in range(0, m, BLOCK):
            total = sums[: min(BLOCK, m - start)]
            for p in range(step):
                first, rows = start * step + p, phases[p]
                for i in range(min(total.size + reach, (x.shape[0] - first + step - 1) // step)):
                    rows[i] = x[first + i * step, k]
            total[:] = 0.0
            for j in range(taps.size):
                tap, rows = taps[j], phases[j % step, j // step : j // step + total.size]
                for i in range(total.size):
                    total[i] += tap * rows[i]
            out[start : start + total.size, k] = total
    return out


@dataclass(frozen=True)
class Smoother:
    """Low-pass of bandwidth `sigma_hz` on a grid of `dt` s, keeping every `step`-th row; of the motor's torque one of
    `motor_hz`, if that is less, with the same rows."""

    sigma_hz: float
    dt: float
    step: int
    motor_hz: float = np.inf

    def of(self, channel: str) -> Smoother:
        """The one that a channel goes through."""
        return self._of_the_motor if channel in "MR" and self.motor_hz < self.sigma_hz else self

    @cached_property
    def _of_the_motor(self) -> Smoother:
        return Smoother(self.motor_hz, self.dt, self.step)

    @cached_property
    def half(self) -> int:
        """Rows of the input lost at each end."""
        return int((kernel(_in_time(min(self.sigma_hz, self.motor_hz)), self.dt, 0).size - 1) // 2)

    def _kernel(self, derivative: int) -> Array:
        return kernel(_in_time(self.sigma_hz), self.dt, derivative)

    def lets_through(self, derivative: int) -> float:
        """RMS of the derivative by time, of that degree, of white noise of which each row has 1."""
        return float(np.linalg.norm(self._kernel(derivative)))

    def rows(self, n: int) -> int:
        """Rows that come out of `n` rows."""
        return max(0, -(-(n - 2 * self.half) // self.step))

    def centres(self, n: int) -> slice:
        """The rows of the input that the rows of the output belong to."""
        return slice(self.half, self.half + (self.rows(n) - 1) * self.step + 1, self.step)

    def __call__(self, x: Array, derivative: int = 0) -> Array:
        """`x` (n,) or (n, k) → derivative 0..3 by time, (rows(n),) or (rows(n), k)."""
        wide = np.ascontiguousarray(x if x.ndim == 2 else x[:, None], dtype=np.float64)
        thin_out = _thinned_narrow if wide.shape[1] < WIDE else _thinned
        taps = _turned_round(self.sigma_hz, self.dt, derivative)
        first = self.half - taps.size // 2  # the rows of a wider low-pass begin later
        out = thin_out(wide[first : wide.shape[0] - first], taps, self.rows(x.shape[0]), self.step)
        return out if x.ndim == 2 else out[:, 0]

    def gain(self, derivative: int) -> float:
        """RMS of the derivative of white noise of RMS 1."""
        return float(np.sqrt(np.sum(self._kernel(derivative) ** 2)))

    def same(self, x: Array, derivative: int = 0) -> Array:
        """The derivative on the grid of `x` itself (n,), the ends held at the nearest valid row."""
        full = np.convolve(x, self._kernel(derivative), mode="same") if x.size > 2 * self.half else np.zeros_like(x)
        if x.size > 2 * self.half:
            full[: self.half] = full[self.half]
            full[x.size - self.half :] = full[x.size - self.half - 1]
        return np.asarray(full)


@lru_cache(maxsize=16)
def _flat(factor: int) -> Array:
    """Low-pass that passes the lower third of the new rate untouched, for taking every `factor`-th row; (odd,)."""
    half = 5 * factor
    t = np.arange(-half, half + 1) / factor
    taps = np.sinc(t) * np.kaiser(t.size, 6.0)  # 6: ripple below 1e-3 between pass band and alias
    return np.asarray(taps / taps.sum())


def thin(x: Array, factor: int) -> tuple[Array, int]:
    """Every `factor`-th row of `x` (n,) without aliases below a third of the new rate; and where it begins."""
    taps = _flat(factor)
    half = (taps.size - 1) // 2
    m = max(0, -(-(x.size - 2 * half) // factor))
    out = np.zeros(m)
    for j, tap in enumerate(taps[::-1]):
        out += tap * x[j : j + (m - 1) * factor + 1 : factor] if m else 0.0
    return out, half


_WIDE = np.sinc(0.72 * np.arange(-10, 11)) * np.kaiser(21, 5.0)
_WIDE /= _WIDE.sum()
"""Passes 0.28 of the sample rate untouched and stops at 0.44 of it: 70 and 110 Hz of 250."""


def flat(x: Array) -> Array:
    """`x` (n,) without what lies above a third of the sample rate: for columns that are not linear."""
    taps = _WIDE
    half = (taps.size - 1) // 2
    if x.size <= 2 * half:
        return x
    return np.convolve(np.pad(x, half, mode="edge"), taps, mode="valid")


STENCILS = {  # central differences of the sixth order: half a per cent low at a fifth of the sample rate
    0: (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0),
    1: (-1 / 60, 3 / 20, -3 / 4, 0.0, 3 / 4, -3 / 20, 1 / 60),
    2: (1 / 90, -3 / 20, 3 / 2, -49 / 18, 3 / 2, -3 / 20, 1 / 90),
    3: (1 / 8, -1.0, 13 / 8, 0.0, -13 / 8, 1.0, -1 / 8),
}


def flat_rate(x: Array, dt: float, derivative: int) -> Array:
    """The derivative of `flat(x)` (n,); the ends are held at the nearest row that has neighbours."""
    taps = np.convolve(np.array(STENCILS[derivative])[::-1], _WIDE) / dt**derivative
    half = (taps.size - 1) // 2
    if x.size <= 2 * half:
        return np.zeros_like(x)
    return np.pad(np.convolve(x, taps, mode="valid"), half, mode="edge")
