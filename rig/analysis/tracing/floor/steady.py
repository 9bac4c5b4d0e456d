"""How loud that part of a residual is that is there all the time, at all frequencies, as noise is."""

from __future__ import annotations

import itertools
from typing import Final

import numpy as np

from rig.model.effect import Array

ROWS: Final = 128  # of a stretch: a second; of noise one is as loud as the next
BANDS: Final = 12  # of the spectrum, each half as wide again as the one below
FEWEST: Final = 16  # frequencies in a band, for their median


def steady(e: Array) -> float:
    """RMS of `e` (n,) without what stands at single frequencies, as a wave of any shape does, or at single times, as a
    rub at one angle does: of noise, pink or white, that is nearly all of it. Where the rows are few, all."""
    whole = float(np.sqrt(np.mean(e**2))) if e.size else 0.0
    return min(whole, _at_all_times(e), _at_all_frequencies(e)) if e.size > 4 * ROWS else whole


def _at_all_times(e: Array) -> float:
    """Median over stretches."""
    stretches = e[: e.size // ROWS * ROWS].reshape(-1, ROWS)
    return float(np.sqrt(np.median(np.mean(stretches**2, axis=1))))


def _at_all_frequencies(e: Array) -> float:
    """Band by band the median power, which of noise is ln 2 of the mean, times the frequencies in it."""
    power = np.abs(np.fft.rfft(e * np.hanning(e.size))[1:]) ** 2
    edges = np.unique(np.round(power.size * 1.5 ** np.arange(-BANDS, 1.0)).astype(int))
    edges = np.concatenate([[0], edges[edges >= FEWEST]])
    total = sum(np.median(power[a:b]) / np.log(2) * (b - a) for a, b in itertools.pairwise(edges))
    return float(np.sqrt(total / max(float(power.sum()), 1e-300) * np.mean(e**2)))
