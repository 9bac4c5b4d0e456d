"""When the rows of a run were taken: how far apart, without gaps, on an even grid."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from rig.analysis.motion.gaps import LONG
from rig.analysis.motion.source import Motion, Source, increases, not_seconds
from rig.analysis.tracing.runs.declared import stated
from rig.core.errors import UsageError
from rig.core.units import TURN
from rig.model.effect import Array

UNTIMED = 1000.0  # Hz, taken for the rate of rows without a time: taken for less, ω̇ of a 16-bit encoder is all noise
FEWEST = 50  # rows; fewer make no piece, nor tell how noisy a reading is
DENSEST = 1e-6  # s between rows: a thousand times faster than any rig logs; the filters grow with the rate
SPARSEST = (
    0.201  # s between rows, 5 Hz as a clock has them: order 15 of a slow run (9.6 rpm) still has two of them a period
)
ROUNDED = 20  # rows, over which the rounding of a stamp is little, and few clocks lose one
OTHER = 0.02  # relative, of a distance that is another one
BRIDGED = 10.0  # usual distances between rows
HARDLY = TURN / 120  # rad of the motor: of order 15 an eighth of a period


def grid(t: Array | None, rows: int, run: Source) -> tuple[Array, float, bool]:
    """Time of each row, s between rows, and whether there is a time at all (else rows count)."""
    if t is None or t.size < 3:
        said = abs(stated(run.manifest, "sample_rate_hz", UNTIMED))
        return np.arange(rows) / said, 1 / said, False
    return t, usual_distance(t), True


def usual_distance(t: Array) -> float:
    """s between rows stamped `t` (n,): the middle one of all distances, or where stamps are rounded so that no distance
    is the usual one, as 300 rows a second in whole milliseconds, that of ROUNDED rows on over as many."""
    nearest = float(np.median(np.diff(t)))
    if t.size <= 2 * ROUNDED:
        return nearest
    wide = float(np.median(t[ROUNDED:] - t[:-ROUNDED])) / ROUNDED
    return wide if abs(wide - nearest) > OTHER * nearest else nearest


def refuse_other_time(t: Array | None, motion: Motion | None) -> None:
    """Raises UsageError for a time in another unit. Without its time a run would say the rest in silence: speeds and
    inertias are what most ask it for."""
    if t is None or motion is None or motion.t is not None:
        return
    known = t[np.isfinite(t)]
    if increases(known) and (wrong := not_seconds(known)):
        raise UsageError(f"t says {wrong}")


def refuse_sparse(rows: int, dt: float) -> None:
    """Raises UsageError for too few rows, and for such as lie too far apart or too close."""
    if rows < FEWEST:
        raise UsageError(f"it has {rows} row{'s' * (rows != 1)}, expected at least {FEWEST}")
    if not DENSEST <= dt <= SPARSEST:  # NaN too
        raise UsageError(f"it has one row every {dt:.4g} s, expected one every {DENSEST:g} to {SPARSEST:.1g} s")


def joined(t: Array, theta_m: Array, dt: float, breaks: Sequence[int], steady: bool) -> list[tuple[int, int]]:
    """Rows lo..hi without a gap or a new encoder reference between them. A few rows in which the motor hardly turned
    are no gap: a curve goes on across them."""
    cuts = set(breaks)
    if steady:
        long = np.flatnonzero(np.diff(t) > LONG * dt)
        bridged = (t[long + 1] - t[long] < BRIDGED * dt) & (np.abs(theta_m[long + 1] - theta_m[long]) < HARDLY)
        cuts |= {int(i) + 1 for i in long[~bridged]}
    edges = [0, *sorted(c for c in cuts if 0 < c < t.size), t.size]
    return [(lo, hi) for lo, hi in itertools.pairwise(edges) if hi - lo > 50]


def is_even(t: Array, dt: float) -> bool:
    """Whether rows lie where an even clock has them."""
    return bool(np.max(np.abs(t - (t[0] + dt * np.arange(t.size)))) < 0.02 * dt)


def uniform(t: Array, x: Array, dt: float) -> Array:
    """`x` on a uniform grid of `dt`; left alone when it already is. Cubic: a straight line between rows 4 ms apart
    takes 6 % from an order at 27 Hz, a cubic 0.2 %."""
    if is_even(t, dt):
        return x
    from scipy.interpolate import CubicSpline  # a tenth of a second, and most loggers keep time

    even = np.arange(t[0], t[-1], dt)
    return np.asarray(CubicSpline(t, x)(even)) if np.isfinite(x).all() else np.interp(even, t, x)
