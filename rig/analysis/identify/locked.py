"""Lock runs: the gear wound up against its stiffness, as rows of the spring's equation."""

from __future__ import annotations

import numpy as np

from rig.analysis.angle import transmission_error
from rig.analysis.identify.gram import Known, known
from rig.analysis.identify.recording import Recording
from rig.analysis.result import Array
from rig.analysis.sums import harmonics

BLOCK = 0.2  # s averaged to one row: noise of the sensor in the regressor is then far below the torque's range
FEWEST = 20  # rows
SWING = 1.0  # N·m at least between the ends, else there is nothing to see
LAGS = 0.25  # of the rows: how far apart residuals are looked at for memory


def locked_rows(run: Recording, terms: int, size: int, at_K: int, c: Array) -> Known | None:
    """θ̃ = θ̃_p(θ_m) + T/K + constant in columns of the spring's fit: (a_n, b_n) first, 1/K at `at_K`, (size,) in all.

    `c` are the coefficients so far (zeros at first): they give the residual, whose memory (creep, hysteresis, stick of
    the motor) says how few independent rows there are.
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
    start = c if c[at_K] > 0 else _first(X, y, at_K, size)
    residual = y - X @ start
    slope = X[:, at_K] / max(float(X[:, at_K] @ X[:, at_K]), 1e-300)
    left = residual - X[:, at_K] * float(slope @ residual)
    variance = float(left @ left) / (count - 2)
    return known(run.name, X, y, max(variance * _memory(left * X[:, at_K]), 1e-20))


def _first(X: Array, y: Array, at_K: int, size: int) -> Array:
    c = np.zeros(size)
    c[at_K] = float(X[:, at_K] @ y) / max(float(X[:, at_K] @ X[:, at_K]), 1e-300)
    return c


def _averaged(rows: Array, each: int, count: int) -> Array:
    return np.asarray(rows[:, : each * count].reshape(rows.shape[0], count, each).mean(axis=2))


def _memory(score: Array) -> float:
    """1 + 2·Σρ_k over the lags until correlation is lost: how many rows tell as much as one independent row."""
    x = score - score.mean()
    power = float(x @ x)
    if power == 0.0:
        return 1.0
    total = 1.0
    for k in range(1, max(int(LAGS * x.size), 2)):
        rho = float(x[k:] @ x[:-k]) / power
        if rho < 2.0 / np.sqrt(x.size):
            break
        total += 2.0 * rho
    return total
