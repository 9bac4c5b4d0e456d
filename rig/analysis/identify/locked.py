"""Lock runs: the gear wound up against its stiffness, as rows of the spring's equation."""

from __future__ import annotations

import numpy as np

from rig.analysis.angle import transmission_error
from rig.analysis.identify.gram import Known, known
from rig.analysis.identify.recording import Recording
from rig.analysis.intervals import Z95, t95
from rig.analysis.result import Array
from rig.analysis.sums import harmonics

BLOCK = 0.2  # s averaged to one row: noise of the sensor in the regressor is then far below the torque's range
FEWEST = 20  # rows
SWING = 1.0  # N·m at least between the ends, else there is nothing to see
PARTS = 12  # of the run: a few seconds each


def locked_rows(run: Recording, terms: int, size: int, at_K: int, c: Array) -> Known | None:
    """θ̃ = θ̃_p(θ_m) + T/K + constant in columns of the spring's fit: (a_n, b_n) first, 1/K at `at_K`, (size,) in all.

    `c` are the coefficients so far, zeros at first: they say what the kinematic error does to the wind-up.
    """
    if not run.locked or run.tau_l is None or np.ptp(run.tau_l) < SWING:
        return None
    rows = max(round(BLOCK / float(np.median(np.diff(run.t)))), 1)
    count = run.t.size // rows
    if count < FEWEST:
        return None
    error = _averaged(transmission_error(run.theta_m, run.theta_l, run.ratio)[None], rows, count)[0]
    X = np.zeros((count, size))
    X[:, : 2 * terms] = _averaged(harmonics(run.theta_m, terms), rows, count).T
    X[:, at_K] = _averaged(run.tau_l[None], rows, count)[0]
    X, y = X - X.mean(axis=0), error - error.mean()
    start = c if c[at_K] > 0 else np.zeros(size)
    torque = X[:, at_K]
    left = y - X @ start + torque * start[at_K]  # what torque alone has to explain
    power = max(float(torque @ torque), 1e-300)
    moved = np.ptp(run.theta_m[: count * rows].reshape(count, rows), axis=1)
    scatter = _slope_variance(torque, left) * (t95(PARTS - 1) / Z95) ** 2
    variance = max(scatter, _counts_variance(torque, moved, run.count_m) / run.ratio**2) * power
    return known(run.name, X, y, max(variance, 1e-20))


def _slope_variance(x: Array, y: Array) -> float:
    """Variance of the slope of `y` against `x`, both about their means, by leaving out a part of the run at a time.

    A motor that sticks keeps the error of one encoder count for seconds, and creep lasts as long: neighbouring rows
    tell the same thing, parts of the run hardly do.
    """
    parts = np.array_split(np.arange(x.size), PARTS)
    squares, products = np.array([x[p] @ x[p] for p in parts]), np.array([x[p] @ y[p] for p in parts])
    without = (products.sum() - products) / np.maximum(squares.sum() - squares, 1e-300)
    return float((PARTS - 1) / PARTS * np.sum((without - without.mean()) ** 2))


def _counts_variance(x: Array, moved: Array, count: float) -> float:
    """Variance [rad²/unit²] of a slope against `x` because the encoder counts: ±½ count, the same as long as it stands.

    `moved`: rad the motor moved within each row; rows without motion share their error with the row before.
    """
    stand = np.cumsum(moved >= count) if count > 0.0 else np.arange(x.size)
    together = np.bincount(stand, x, minlength=int(stand[-1]) + 1)
    return float(count**2 / 12.0 * np.sum(together**2) / max(float(x @ x), 1e-300) ** 2)


def _averaged(rows: Array, each: int, count: int) -> Array:
    return np.asarray(rows[:, : each * count].reshape(rows.shape[0], count, each).mean(axis=2))
