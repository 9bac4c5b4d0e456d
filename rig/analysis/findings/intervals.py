"""From scatter to intervals: Student's factor, means of correlated revolutions, amplitudes that may be zero, limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array, Verdict
from rig.core.quantiles import Z95

_T95 = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)  # Student, 1 to 10 degrees of freedom
RAYLEIGH95 = 2.448  # √(−2·ln 0.05): an amplitude of pure noise stays below this many σ in 95 % of cases


@dataclass(frozen=True)
class Ranged:
    """A value and its 95 % interval, in a unit its owner says."""

    value: float
    low: float
    high: float


def t95(dof: float) -> float:
    """Two-sided 95 % factor of Student's t for `dof` degrees of freedom (rounded down, at least 1)      [gum, G.3]

    Within 0.1 % of the tables; written out because importing scipy.stats costs more than the rest of an analysis.
    """
    n = max(int(dof), 1)
    if n <= len(_T95):
        return _T95[n - 1]
    z = Z95
    first = (z**3 + z) / 4
    second = (5 * z**5 + 16 * z**3 + 3 * z) / 96
    third = (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384
    return z + first / n + second / n**2 + third / n**3


def rms_of_pieces(squares: Array, rows: Array) -> tuple[float, float]:
    """(rms, half width of its 95 % interval) of pieces with a sum of `squares` (n,) over `rows` (n,) each.

    Rows need not be independent, pieces are taken to be; the half of a single piece is NaN.
    """
    rms, n = float(np.sqrt(max(squares.sum(), 0.0) / max(rows.sum(), 1.0))), squares.size
    if n < 2:
        return rms, float("nan")
    spread = float(np.std(squares / np.maximum(rows, 1.0), ddof=1))
    return rms, t95(n - 1) * spread / float(np.sqrt(n)) / (2.0 * rms) if rms > 0.0 else 0.0


def neighbour_correlation(series: list[Array]) -> float:
    """Correlation of neighbouring rows, one figure for all columns.

    `series`: arrays (rows, columns) of deviations whose rows follow each other in time (the revolutions of one stroke).
    Each column is scaled to its own scatter first; the bias −1/rows from having removed a mean is put back. Zero
    unless it stands two standard errors above zero: inflating by noise would make the intervals dishonest too.
    """
    joined = np.concatenate(series)
    rows = joined.shape[0]
    scale = np.sqrt(np.mean(joined**2, axis=0))
    usable = scale > 0
    pairs = sum(s.shape[0] - 1 for s in series)
    if pairs < 4 or not usable.any():
        return 0.0
    product = sum(float(np.sum((s[:-1, usable] / scale[usable]) * (s[1:, usable] / scale[usable]))) for s in series)
    count = pairs * int(usable.sum())
    rho = product / count + 1.0 / rows
    return min(rho, 0.8) if rho > 2.0 / np.sqrt(count) else 0.0


def inflation(rho: float) -> float:
    """(1 + ρ)/(1 − ρ): how much wider the variance of a mean is when neighbours correlate by `rho`."""
    return (1.0 + rho) / (1.0 - rho)


def amplitude_interval(amplitude: float, u: float, factor: float) -> tuple[float, float, float]:
    """(value, low, high) of an amplitude √(a² + b²) whose parts carry the standard uncertainty `u`.

    The value is freed of the bias that noise adds, √(C² − u²). Where pure noise would reach C in 1 case of 20, the
    amplitude is not resolved: the interval then starts at zero. `factor` is the 95 % factor of one part.
    """
    if not np.isfinite(u):  # one revolution: a value, and nothing to say how sure it is
        return amplitude, float("nan"), float("nan")
    value = float(np.sqrt(max(amplitude**2 - u**2, 0.0)))
    resolved = amplitude > RAYLEIGH95 / Z95 * factor * u
    low = max(amplitude - factor * u, 0.0) if resolved else 0.0
    return value, low, amplitude + factor * u


def against_limit(ci95: tuple[float, float], lower: float | None, upper: float | None) -> Verdict:
    """PASS when the whole interval is inside the limits, FAIL when it is wholly outside, else INCONCLUSIVE.

    The guard band is the expanded uncertainty itself, on either side of a limit      [gum, 6.3]
    """
    low, high = ci95
    if not (np.isfinite(low) and np.isfinite(high)):
        return Verdict.INCONCLUSIVE
    floor, ceiling = -np.inf if lower is None else lower, np.inf if upper is None else upper
    if low >= floor and high <= ceiling:
        return Verdict.PASS
    if high < floor or low > ceiling:
        return Verdict.FAIL
    return Verdict.INCONCLUSIVE
