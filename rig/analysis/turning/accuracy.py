"""Transmission accuracy in the makers' sense: greatest less least error over one turn of the output, one direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.findings.unbiased import phasor_draws, unbiased
from rig.core.quantiles import Z95
from rig.core.units import TURN

Complex = npt.NDArray[np.complex128]
BINS = 64  # pieces a turn of the wave generator: order 15 has four of them a period
FINER = 4  # points a piece at which the curve of the lines is looked at: order 2 then loses 0.1 % of its peak at most
LINE = 6.0  # times the local noise power that a bin of the spectrum must have to be a line; noise does in 1 of 400
MARGIN = 1.5  # the noise rises towards low orders, where the lines are: its power is known to half only
AROUND = 25  # bins on either side from which the local noise is taken: half an order of the wave generator at N = 50
DRAWS = 400  # Monte Carlo draws: the 95 % limits then repeat to a few per cent


@dataclass(frozen=True)
class Accuracy:
    """θ̃ over one turn of the output, arcsec."""

    value: float  # greatest less least of what repeats with the gear
    low: float  # 95 % interval
    high: float
    recorded: float  # greatest less least of the curve as it is, noise included
    theta_l_deg: Array  # (B,) output angle from where the turn begins
    curve: Array  # (B,) θ̃ less its mean, mean over the turns
    levelled: Array  # (n,) θ̃ of all rows less the drift between the turns
    bins: int


def accuracy(theta_m: Array, error: Array, ratio: float, turns: int) -> Accuracy:
    """Over `turns` whole turns of the output in one direction; `theta_m` rad and `error` arcsec, both (n,).

    With several turns a drift between them is taken off first (one turn cannot tell it from an error once per turn).
    What repeats with the gear stands as lines in the curve's spectrum; the rest is noise (friction that wanders,
    counts), which makes the greatest less least of the curve itself too large. Interval and bias: the noise beside each
    line, drawn into it.
    """
    way = np.abs(theta_m - theta_m[0]) / (TURN * ratio)  # turns of the output
    level = _without_drift(way, error, turns)
    bins = max(int(BINS * ratio), 4 * AROUND)
    curve = _in_bins(way % 1.0, level, bins)
    spectrum = np.fft.rfft(curve)
    noise = _local_noise(np.abs(spectrum) ** 2)
    lines = np.where(np.abs(spectrum) ** 2 > LINE * noise, spectrum, 0.0)
    lines[0] = 0.0
    value, half = _greatest_less_least(lines, noise, bins)
    angle = (np.arange(bins) + 0.5) / bins * 360.0
    return Accuracy(value, max(value - half, 0.0), value + half, float(np.ptp(curve)), angle, curve, level, BINS)


def _without_drift(way: Array, error: Array, turns: int) -> Array:
    """The means of the turns on one line taken off; for one turn nothing but the mean."""
    level = np.asarray(error - error.mean(), dtype=np.float64)
    if turns < 2:
        return level
    which = np.minimum(way.astype(np.int64), turns - 1)
    means = np.bincount(which, level, turns) / np.maximum(np.bincount(which, minlength=turns), 1)
    slope = float(np.polyfit(np.arange(turns), means, 1)[0])
    return np.asarray(level - slope * (way - 0.5 * turns))


def _in_bins(place: Array, y: Array, bins: int) -> Array:
    """Means of `y` in equal pieces of a turn, `place` in 0..1; empty ones from their neighbours; less the mean."""
    index = np.minimum((place * bins).astype(np.int64), bins - 1)
    rows = np.bincount(index, minlength=bins)
    here = np.flatnonzero(rows)
    mean = np.bincount(index, y, bins)[here] / rows[here]
    full = np.interp(np.arange(bins), here, mean, period=bins)
    return np.asarray(full - full.mean())


def _local_noise(power: Array) -> Array:
    """Mean noise power around each bin, from the median of its neighbours, which lines do not lift."""
    ends = np.pad(power[1:], AROUND, mode="reflect")
    noise = np.median(np.lib.stride_tricks.sliding_window_view(ends, 2 * AROUND + 1), axis=1) / np.log(2.0)
    return np.concatenate(([0.0], np.maximum(noise, 1e-300)))


def _greatest_less_least(lines: Complex, noise: Array, bins: int) -> tuple[float, float]:
    """Of the curve that the `lines` make, freed of bias, and half its 95 % interval, arcsec."""
    at = np.flatnonzero(lines)
    flat = np.sinc(at / bins)  # what averaging over a piece takes from each line

    def size(values: Complex) -> float:
        spectrum = np.zeros(FINER * bins // 2 + 1, dtype=np.complex128)
        spectrum[at] = FINER * values / flat
        return float(np.ptp(np.fft.irfft(spectrum, FINER * bins)))

    scatter = np.sqrt(0.5 * MARGIN * noise[at])
    sizes = np.array([size(lines[at] + scatter * draw) for draw in phasor_draws(DRAWS, at.size)])
    value, sigma = unbiased(size(lines[at]), sizes)
    return value, Z95 * sigma
