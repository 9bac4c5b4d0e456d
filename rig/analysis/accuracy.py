"""Transmission accuracy in the makers' sense: greatest less least error over one turn of the output, one direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.angle import TURN
from rig.analysis.result import Array

BINS = 64  # pieces a turn of the wave generator: order 15 has four of them a period
SMOOTH = 31  # orders of the wave generator on either side of which nothing but noise is left
DRAWS = 400  # Monte Carlo draws: the 95 % limits then repeat to a few per cent


@dataclass(frozen=True)
class Accuracy:
    """θ̃ over one turn of the output, arcsec."""

    value: float  # greatest less least, freed of what noise adds
    low: float  # 95 % interval
    high: float
    theta_l_deg: Array  # (B,) output angle from where the turn begins
    curve: Array  # (B,) θ̃ less its mean, mean over the turns
    levelled: Array  # (n,) θ̃ of all rows less the drift between the turns
    bins: int


def accuracy(theta_m: Array, error: Array, ratio: float, turns: int) -> Accuracy:
    """Over `turns` whole turns of the output in one direction; `theta_m` rad and `error` arcsec, both (n,).

    With several turns a drift between them is taken off first (one turn cannot tell it from an error once per turn).
    The curve's noise is what changes faster than the wave generator's orders do: from it, shifted along the turn by
    chance, come the interval and the bias, for a greatest less least of noisy values is too large.
    """
    way = np.abs(theta_m - theta_m[0]) / (TURN * ratio)  # turns of the output
    level = _without_drift(way, error, turns)
    bins = max(int(BINS * ratio), 16)
    place = np.minimum(((way % 1.0) * bins).astype(np.int64), bins - 1)
    rows = np.bincount(place, minlength=bins)
    mean = np.bincount(place, level, bins) / np.maximum(rows, 1)
    if (rows == 0).any():
        here = rows > 0
        mean = np.interp(np.arange(bins), np.flatnonzero(here), mean[here], period=bins)
    mean -= mean.mean()
    smooth = _below(mean, int(SMOOTH * ratio))
    return _with_noise(mean, smooth, _noise(mean, ratio), level)


def _without_drift(way: Array, error: Array, turns: int) -> Array:
    """The means of the turns on one line taken off; for one turn nothing but the mean."""
    level = np.asarray(error - error.mean(), dtype=np.float64)
    if turns < 2:
        return level
    which = np.minimum(way.astype(np.int64), turns - 1)
    means = np.bincount(which, level, turns) / np.maximum(np.bincount(which, minlength=turns), 1)
    slope = float(np.polyfit(np.arange(turns), means, 1)[0])
    return np.asarray(level - slope * (way - 0.5 * turns))


def _below(curve: Array, harmonics: int) -> Array:
    """The part of a periodic curve with at most that many periods a turn."""
    spectrum = np.fft.rfft(curve)
    spectrum[harmonics + 1 :] = 0.0
    return np.asarray(np.fft.irfft(spectrum, curve.size))


def _noise(curve: Array, ratio: float) -> Array:
    """What is left of `curve` without the orders a gear makes: n, n ± k/N for k ≤ 2n, and 1 to 8 per output turn."""
    spectrum = np.fft.rfft(curve)
    keep = np.ones(spectrum.size, dtype=bool)
    keep[: min(9, keep.size)] = False
    for n in range(1, 16):
        centre, width = round(n * ratio), min(2 * n, round(0.4 * ratio))
        keep[max(centre - width, 0) : centre + width + 1] = False
    share = max(float(keep.mean()), 1e-3)
    noise = np.fft.irfft(np.where(keep, spectrum, 0.0), curve.size)
    return np.asarray(noise / np.sqrt(share))  # as strong as if the orders left out had their share of it


def _with_noise(mean: Array, smooth: Array, noise: Array, level: Array) -> Accuracy:
    rng = np.random.default_rng(0)  # the same run gives the same interval
    plain = float(np.ptp(mean))
    draws = np.array(
        [np.ptp(smooth + rng.choice((-1.0, 1.0)) * np.roll(noise, rng.integers(noise.size))) for _ in range(DRAWS)]
    )
    bias = float(draws.mean()) - float(np.ptp(smooth))
    half = 1.96 * float(draws.std())
    value = max(plain - max(bias, 0.0), 0.0)
    angle = (np.arange(mean.size) + 0.5) / mean.size * 360.0
    return Accuracy(value, max(value - half, 0.0), value + half, angle, mean, level, BINS)
