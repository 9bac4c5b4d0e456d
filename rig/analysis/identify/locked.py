"""Lock runs: the gear wound up against its stiffness, as rows of the spring's equation."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.identify.gram import Known, known
from rig.analysis.identify.recording import Recording
from rig.analysis.orders.sums import harmonics
from rig.core.quantiles import Z95
from rig.core.units import TURN
from rig.model.transmission_error import transmission_error

BLOCK = 0.2  # s averaged to one row: noise of the sensor in the regressor is then far below the torque's range
FEWEST = 20  # rows
SWING = 1.0  # N·m at least between the ends, else there is nothing to see
NEAR = math.radians(3.0)  # of the motor: half of what 15 N·m wind the paper's gear up by, so most counts are the same
BESIDE = 5  # stands either way: a ramp goes on by more than a count within them
PARTS = 12  # of the run: a few seconds each


def locked_rows(run: Recording, terms: int, size: int, at_K: int, c: Array, alike: int) -> Known | None:
    """θ̃ = θ̃_p(θ_m) + T/K + constant in columns of the spring's fit: (a_n, b_n) first, 1/K at `at_K`, (size,) in all.

    `c` are the coefficients so far, zeros at first: they say what the kinematic error does to the wind-up. `alike` runs
    of the campaign, this one among them, wind up about the same angle: they share the errors of the encoder's counts,
    and all of them together know those no better than one.
    """
    if not run.locked or run.tau_l is None or np.ptp(run.tau_l) < SWING:
        return None
    rows = max(round(BLOCK / float(np.median(np.diff(run.t)))), 1)
    count = run.t.size // rows
    if count < FEWEST:
        return None
    theta = run.theta_m[: count * rows].reshape(count, rows)
    stand = _stands(theta, run.count_m)
    ramp = ~_turning(_once(theta.mean(axis=1)[None], stand)[:, 0], run.count_m)
    if ramp.sum() < FEWEST:
        return None
    error = _once(_averaged(transmission_error(run.theta_m, run.theta_l, run.ratio)[None], rows, count), stand)[:, 0]
    error = error[ramp]
    X = np.zeros((error.size, size))
    X[:, : 2 * terms] = _once(_averaged(harmonics(run.theta_m, terms), rows, count), stand)[ramp]
    X[:, at_K] = _once(_averaged(run.tau_l[None], rows, count), stand)[ramp, 0]
    X, y = X - X.mean(axis=0), error - error.mean()
    start = c if c[at_K] > 0 else np.zeros(size)
    torque = X[:, at_K]
    left = y - X @ start + torque * start[at_K]  # what torque alone has to explain
    power = max(float(torque @ torque), 1e-300)
    scatter = _slope_variance(torque, left) * (t95(PARTS - 1) / Z95) ** 2
    counts = alike * (run.count_m / run.ratio) ** 2 / 12.0 / power
    # parts of the run show what changes from one to the next; the counts are the same ones on every ramp
    variance = (scatter + counts) * power
    return known(run.name, X, y, max(variance, 1e-20))


def about_the_same_angle(run: Recording, others: Sequence[Recording]) -> int:
    """How many of `others` wind the motor up about the angle at which `run` does, `run` among them."""
    apart = [math.remainder(float(np.mean(run.theta_m) - np.mean(other.theta_m)), TURN) for other in others]
    return max(sum(abs(a) < NEAR for a in apart), 1)


def _slope_variance(x: Array, y: Array) -> float:
    """Variance of the slope of `y` against `x`, both about their means, by leaving out a part of the run at a time.

    A motor that sticks keeps the error of one encoder count for seconds, and creep lasts as long: neighbouring rows
    tell the same thing, parts of the run hardly do.
    """
    parts = np.array_split(np.arange(x.size), PARTS)
    squares, products = np.array([x[p] @ x[p] for p in parts]), np.array([x[p] @ y[p] for p in parts])
    without = (products.sum() - products) / np.maximum(squares.sum() - squares, 1e-300)
    return float((PARTS - 1) / PARTS * np.sum((without - without.mean()) ** 2))


def _stands(theta: Array, one: float) -> npt.NDArray[np.int64]:
    """(rows,) number of the stand each row of `theta` (rows, samples) belongs to; `one` rad a count, 0 unknown."""
    if one <= 0.0:
        return np.arange(theta.shape[0])
    moved = np.ptp(theta, axis=1) >= one
    moved[1:] |= np.abs(np.diff(theta.mean(axis=1))) >= 0.5 * one
    moved[0] = False
    return np.cumsum(moved)


def _once(rows: Array, stand: npt.NDArray[np.int64]) -> Array:
    """(stands, columns): one row for as long as the motor stood within a count, where all have the same error."""
    lasts = np.bincount(stand)
    return np.array([np.bincount(stand, row) / lasts for row in rows]).T


def _turning(theta: Array, one: float) -> npt.NDArray[np.bool_]:
    """(stands,) where the motor at `theta` rad turned round, a count either way; nowhere where `one` is 0, unknown.

    A loop that holds an angle stops where the count turns over, on the side it came from: at both ends of a wind-up
    that is the outer one. Such a stand reads half a count too far out where it has the most leverage: two of them in
    200 rows make the gear 0.01 % too soft.
    """
    if one <= 0.0:
        return np.zeros(theta.size, dtype=bool)
    around = np.lib.stride_tricks.sliding_window_view(np.pad(theta, BESIDE, mode="edge"), 2 * BESIDE + 1)
    return np.asarray((theta >= around.max(axis=1) - one) | (theta <= around.min(axis=1) + one))


def _averaged(rows: Array, each: int, count: int) -> Array:
    return np.asarray(rows[:, : each * count].reshape(rows.shape[0], count, each).mean(axis=2))
