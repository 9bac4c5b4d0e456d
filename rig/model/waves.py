"""Cosines, sines and Fourier sums along a run, compiled: of the work of a trace these were a quarter.

An angle less a whole number of quarter turns is known to all digits when π/2 is taken off in parts, the first of which
has so few digits that its multiples are exact      [cody1980]; of what is left, ±π/4, a Taylor series to the 17th power
has all digits of a double. Vectors of the processor take several angles at once.
"""

from __future__ import annotations

import math
from fractions import Fraction
from math import factorial
from typing import Final

import numpy as np
import numpy.typing as npt
from numba import njit

from rig.model.fourier import FourierSeries

Array = npt.NDArray[np.float64]

QUARTER: Final = Fraction("1.57079632679489661923132169163975144209858469968755291")  # π/2
DIGITS: Final = 32  # binary ones, of each part but the last
FIRST: Final = round(QUARTER * 2**DIGITS) / 2**DIGITS
SECOND: Final = round((QUARTER - Fraction(FIRST)) * 2 ** (2 * DIGITS)) / 2 ** (2 * DIGITS)
THIRD: Final = float(QUARTER - Fraction(FIRST) - Fraction(SECOND))
FURTHEST: Final = 1e6  # rad: multiples of the first part are exact up to there, 160 000 turns
SINE: Final = tuple((-1) ** k / factorial(2 * k + 1) for k in range(1, 9))
COSINE: Final = tuple((-1) ** k / factorial(2 * k) for k in range(1, 9))
BLOCK: Final = 512  # angles, which stay in the nearest cache


def cosine_and_sine(angle: Array) -> tuple[Array, Array]:
    """Of `angle` rad (n,), each (n,), to the last digit but one."""
    cos, sin = np.empty(angle.size), np.empty(angle.size)
    if not _turned(np.ascontiguousarray(angle), cos, sin):  # too far, or one is not finite
        return np.cos(angle), np.sin(angle)
    return cos, sin


def wave(angle: Array, height: Array | None = None) -> Array:
    """Cosine and sine of `angle` rad (n,) side by side, (n, 2); `height` (n,) times them."""
    cos, sin = cosine_and_sine(angle)
    out = np.empty((angle.size, 2))
    if height is None:
        out[:, 0], out[:, 1] = cos, sin
    else:
        np.multiply(cos, height, out=out[:, 0])
        np.multiply(sin, height, out=out[:, 1])
    return out


def powers(angle: Array, orders: int, slopes: bool = False) -> Array:
    """cos kθ, sin kθ in turn, k = 1..`orders`, of `angle` θ rad (n,), or their `slopes` −k·sin kθ, k·cos kθ;
    (n, 2·orders)."""
    cos, sin = cosine_and_sine(angle)
    out = np.empty((angle.size, 2 * orders))
    _powers(cos, sin, out)
    if slopes:
        _sloped(out)
    return out


def sums(series: FourierSeries, angle: Array, *derivatives: int) -> tuple[Array, ...]:
    """θ̃_p of `series` at `angle` rad (n,), or its derivatives by the angle, (n,) each: as `series` itself says,
    in an eighth of the time."""
    phasors = np.asarray(series.a) - 1j * np.asarray(series.b)
    terms = np.array([(1j * series.orders) ** derivative * phasors for derivative in derivatives])
    out = np.empty((len(derivatives), angle.size))
    _sums(*cosine_and_sine(angle), terms.real.copy(), terms.imag.copy(), out)
    return tuple(out)


@njit(cache=True, nogil=True)
def left_of(order: float, omega: Array, dt: float, rate: float) -> Array:
    """Share (n,) of a wave of `order` periods a turn at `omega` rad/s (n,) that is left in rows `dt` s apart, brought
    down from readings at `rate` Hz: all below a third of the rows' own rate, nothing above two thirds; readings fold
    over what is faster than half of theirs."""
    out = np.ones(omega.size)
    slow, limit = 0, 2.0 * math.pi / (3.0 * dt * order)
    for i in range(omega.size):
        slow += 1 if abs(omega[i]) < limit else 0
    if slow == omega.size:
        return out
    for i in range(omega.size):
        hz = order * abs(omega[i]) / (2.0 * math.pi)
        beyond = 3.0 * abs(hz - rate * np.rint(hz / rate)) * dt - 1.0
        if beyond > 0.0:
            out[i] = 0.5 + 0.5 * math.cos(math.pi * min(beyond, 1.0))
    return out


@njit(cache=True, nogil=True)
def _turned(angle: Array, cos: Array, sin: Array) -> bool:
    """False, and nothing made, where an angle is too far or not finite."""
    near = 0
    for i in range(angle.size):
        near += 1 if abs(angle[i]) < FURTHEST else 0
    if near < angle.size:
        return False
    for i in range(angle.size):
        turns = np.rint(angle[i] / 1.5707963267948966)
        x = ((angle[i] - turns * FIRST) - turns * SECOND) - turns * THIRD
        z = x * x
        s, c = SINE[7], COSINE[7]
        for k in range(6, -1, -1):
            s, c = SINE[k] + z * s, COSINE[k] + z * c
        s, c = x + x * z * s, 1.0 + z * c
        quarter = turns - 4.0 * np.floor(0.25 * turns)
        swapped = quarter == 1.0 or quarter == 3.0
        a, b = (s, c) if swapped else (c, s)
        cos[i] = -a if quarter == 1.0 or quarter == 2.0 else a
        sin[i] = -b if quarter >= 2.0 else b
    return True


@njit(cache=True, nogil=True)
def _powers(cos: Array, sin: Array, out: Array) -> None:
    for i in range(cos.size):
        c, s = cos[i], sin[i]
        a, b = c, s
        out[i, 0], out[i, 1] = a, b
        for k in range(1, out.shape[1] // 2):
            a, b = a * c - b * s, b * c + a * s
            out[i, 2 * k], out[i, 2 * k + 1] = a, b


@njit(cache=True, nogil=True)
def _sloped(waves: Array) -> None:
    for i in range(waves.shape[0]):
        for k in range(waves.shape[1] // 2):
            cos, sin = waves[i, 2 * k], waves[i, 2 * k + 1]
            waves[i, 2 * k], waves[i, 2 * k + 1] = -(k + 1) * sin, (k + 1) * cos


@njit(cache=True, nogil=True)
def _sums(cos: Array, sin: Array, real: Array, imag: Array, out: Array) -> None:
    """Real part of Σ (real + i·imag)_k·e^{ikθ} for each row of terms."""
    across = np.empty(BLOCK)
    for start in range(0, cos.size, BLOCK):
        c, s = cos[start : start + BLOCK], sin[start : start + BLOCK]
        for d in range(real.shape[0]):
            _horner(c, s, real[d], imag[d], out[d, start : start + BLOCK], across)


@njit(cache=True, nogil=True)
def _horner(c: Array, s: Array, real: Array, imag: Array, along: Array, across: Array) -> None:
    """Real parts (n,) of a block by Horner's rule; `across` has room for the imaginary ones."""
    for i in range(c.size):
        along[i], across[i] = 0.0, 0.0
    for k in range(real.size - 1, -1, -1):
        more, beside = real[k], imag[k]
        for i in range(c.size):
            a, b = along[i] + more, across[i] + beside
            along[i], across[i] = a * c[i] - b * s[i], a * s[i] + b * c[i]
