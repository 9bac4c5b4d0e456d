"""Ways to read the rest along a coordinate: fitted to some rows, each foretells all of them, with what it changes of
the baseline and without zeros of runs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from numpy.polynomial.chebyshev import chebvander

from rig.analysis.tracing.rest.binned import Halves, binned, solved
from rig.analysis.tracing.rest.joined import Index, Rest
from rig.model.effect import Array

Rows = npt.NDArray[np.bool_]
Reading = Callable[[Rest, Rows], Array]
"""What the rows (n, bool) it is fitted to foretell of every row, (n,)."""

WAVES = 6  # orders of the motor angle: most of the paper's kinematic error
DRIFT = 8  # degree: half an oscillation a sixteenth of a campaign
POWERS = 5  # of an angle gone: a cable's spring, its slack, its end


def in_bins(index: Callable[[Rest], Index]) -> Reading:
    """One value a bin."""

    def read(r: Rest, rows: Rows) -> Array:
        """Bins of `rows` (n,), for all."""
        at = index(r)
        found = binned(r, at, rows)
        return np.nan_to_num(found.guess(at, r.worth) + r.z @ found.beside.shift)

    return read


def in_columns(columns: Callable[[Rest], Array]) -> Reading:
    """Least squares on columns (n, k); what is not finite foretells nothing."""

    def read(r: Rest, rows: Rows) -> Array:
        """Coefficients of `rows` (n,), for all."""
        z = columns(r)
        good = np.asarray(np.isfinite(z).all(1))
        z = np.hstack([r.over_the_floor(np.where(good[:, None], z, 0.0)), r.z])
        fitted = rows & good
        e = r.e
        if r.own_zeros:
            z, e = z - means(r, fitted, z), e - means(r, fitted)
        normal = z[fitted].T @ z[fitted]
        first = z.shape[1] - r.z.shape[1]
        normal[first:, first:] += r.known * int(fitted.sum())
        return np.asarray(z @ solved(normal, z[fitted].T @ e[fitted]))

    return read


def nothing(r: Rest) -> Array:
    """No column, (n, 0): zeros of the runs and the baseline alone."""
    return np.zeros((r.e.size, 0))


def means(r: Rest, rows: Rows, of: Array | None = None) -> Array:
    """Mean over those `rows` of each run, of the rest (n,) or of columns (n, k), at every row; 0 without any."""
    values = (r.e if of is None else of).reshape(r.e.size, -1)
    runs, run = np.unique(r.run, return_inverse=True)
    seen = np.maximum(np.bincount(run[rows], minlength=runs.size), 1)
    made = [np.bincount(run[rows], column[rows], minlength=runs.size) / seen for column in values.T]
    return np.stack(made, 1)[run].reshape((r.e if of is None else of).shape)


def waves(x: Array, order: float) -> Array:
    """Cosine and sine of one order, (n, 2)."""
    return np.stack([np.cos(order * x), np.sin(order * x)], 1)


def powers(x: Array) -> Array:
    """x to x⁵ of an angle over its largest, (n, 5)."""
    top = float(np.nanmax(np.abs(x), initial=1e-9))
    return (x / top)[:, None] ** np.arange(1, POWERS + 1)


def swelling(angle: Array, x: Array) -> Array:
    """The first waves of an angle that grow with `x`, and with its square, (n, 4·WAVES)."""
    top = float(np.nanmax(np.abs(x), initial=1e-9))
    shapes = np.hstack([waves(angle, k) for k in range(1, WAVES + 1)])
    return np.hstack([shapes * (x / top)[:, None] ** power for power in (1, 2)])


def drifting(t: Array) -> Array:
    """Slow changes over a campaign, (n, DRIFT): Chebyshev polynomials of its time."""
    low, high = float(t.min()), float(t.max())
    return np.asarray(chebvander(2 * (t - low) / max(high - low, 1e-9) - 1, DRIFT)[:, 1:])


def share(h: Halves, read: Reading) -> float:
    """Of the excess, what each fold foretells of the other beyond what zeros alone do."""
    r, gain = h.rest, 0.0
    for test in (0, 1):
        seen = h.fold == test
        e = r.e - (means(r, ~seen) if r.own_zeros else 0.0)
        gain += float(np.sum(e[seen] ** 2 - (e - read(r, ~seen))[seen] ** 2))
    return gain / max(r.e.size, 1) / h.total
