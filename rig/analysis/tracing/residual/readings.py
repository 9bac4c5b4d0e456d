"""Ways to read the rest along a coordinate: fitted to some rows, each foretells all of them, with what it changes of
the baseline and without zeros of runs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from numpy.polynomial.chebyshev import chebvander

from rig.analysis.tracing.residual.binned import Halves, added, binned, solved
from rig.analysis.tracing.residual.joined import Index, Rest
from rig.model.effect import Array

Rows = npt.NDArray[np.bool_]
Reading = Callable[[Rest, Rows], Array]
"""What the rows (n, bool) it is fitted to foretell of every row, (n,)."""

WAVES = 6  # orders of the motor angle: most of the paper's kinematic error
DRIFT = 8  # degree: half an oscillation a sixteenth of a campaign
ROUNDED = 1e-10  # of a column's square: more than what rounding leaves of one that is even within each run
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
        z = r.over_the_floor(z if good.all() else np.where(good[:, None], z, 0.0))
        fitted = rows & good
        normal, right, mean = _normal(r, z, fitted)
        k = z.shape[1]
        normal[k:, k:] += r.known * int(fitted.sum())
        x = solved(normal, right)
        return np.asarray(z @ x[:k] + r.z @ x[k:] - (mean @ x)[r.whole.run])

    return read


def _normal(r: Rest, z: Array, fitted: Rows) -> tuple[Array, Array, Array]:
    """Of columns `z` (n, k) and the baseline's over the rows `fitted`: normal matrix (k + p, k + p) and right side,
    about the means of runs where these have zeros of their own; and those means by run (r, k + p). What all rows of the
    baseline come to is known: those left out are taken off it."""
    all_of, out = r.whole, np.flatnonzero(~fitted)
    less = all_of.wide[out]
    here = np.where(fitted[:, None], z, 0.0)
    across = here.T @ all_of.wide
    gram = np.block([[here.T @ here, across], [across.T, all_of.gram - less.T @ less]])
    runs = all_of.runs.size
    by_run = np.hstack(
        [
            added(all_of.run, runs, np.ones(r.e.size)) @ here,
            all_of.by_run - added(all_of.run[out], runs, np.ones(out.size)) @ less,
        ]
    )
    mean = by_run / np.maximum(by_run[:, -1:], 1.0) if r.own_zeros else np.zeros_like(by_run)
    about = gram - mean.T @ by_run
    p = gram.shape[0] - 2
    about[np.diag_indices(p)] += ROUNDED * np.diag(gram)[:p]
    return about[:p, :p], about[:p, p], mean[:, :p]


def nothing(r: Rest) -> Array:
    """No column, (n, 0): zeros of the runs and the baseline alone."""
    return np.zeros((r.e.size, 0))


def means(r: Rest, rows: Rows, of: Array | None = None) -> Array:
    """Mean over those `rows` of each run, of the rest (n,) or of columns (n, k), at every row; 0 without any."""
    values = (r.e if of is None else of).reshape(r.e.size, -1)
    run, runs = r.whole.run, r.whole.runs.size
    seen = np.maximum(np.bincount(run, rows, minlength=runs), 1)
    made = [np.bincount(run, np.where(rows, column, 0.0), minlength=runs) / seen for column in values.T]
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


def accelerating(r: Rest) -> Array:
    """The first waves of the motor's angle as large as the square of its speed, (n, 2·WAVES)."""
    square = np.square(r.at["speed"])
    shapes = np.hstack([waves(r.at["motor_angle"], k) for k in range(1, WAVES + 1)])
    return shapes * (square / max(float(np.nanmax(square, initial=0.0)), 1e-9))[:, None]


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
