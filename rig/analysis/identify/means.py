"""Mean torques of every plateau: what friction and damping of both sides are found from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rig.analysis.angle import TURN
from rig.analysis.identify.recording import Plateau
from rig.analysis.result import Array
from rig.model.fourier import FourierSeries

PIECE = 1.0  # s at least, in whole turns: longer than friction remembers (0.3 s on the twin)


@dataclass(frozen=True)
class Mean:
    """One plateau, SI. Motor: what drives it less what the load takes; load: what the gear gives and what hangs there.

    `motor` and `load` are NaN without the torques they need. Scatter is 1 σ of a piece, NaN of one.
    """

    run: str
    omega: float  # rad/s of the motor
    duration: float  # s
    pieces: int
    motor: float  # mean of τ_m − τ_l·(1/N − θ̃_p′) − J_m·ω̇_m, N·m
    load: float  # mean of τ_l + τ_ext − J_l·ω̇_l, N·m
    motor_scatter: float  # N·m, 1 σ of a piece
    load_scatter: float
    total: float  # mean of τ_m, all that the rig rubs, N·m
    total_scatter: float
    begin: float  # s, when the plateau began
    tau_ext: float

    @property
    def way(self) -> float:
        """±1"""
        return float(np.sign(self.omega))


def mean_of(plateau: Plateau, series: FourierSeries, J_m: float, J_l: float) -> Mean:
    """The plateau's means; `series` gives the lever of the shaft torque at the motor, inertias what its drift took."""
    run, part = plateau.run, slice(plateau.lo, plateau.hi)
    t, theta = run.t[part], run.theta_m[part]
    drift = _drift(t, theta)
    nothing = np.full(theta.size, np.nan)
    tau_l = nothing if run.tau_l is None else run.tau_l[part]
    tau_m = nothing if run.tau_m is None else run.tau_m[part]
    lever = 1.0 / run.ratio - series.slope(theta)
    edges = _edges(theta, t)
    motor = _pieces(tau_m - tau_l * lever - J_m * drift, edges)
    load = _pieces(tau_l + run.tau_ext - J_l * drift / run.ratio, edges)
    total = _pieces(tau_m, edges)
    return Mean(
        run.name, plateau.omega, plateau.duration, motor.size,
        float(np.mean(motor)), float(np.mean(load)), _scatter(motor), _scatter(load),
        float(np.mean(total)), _scatter(total), float(t[0]), run.tau_ext,
    )  # fmt: skip


def _drift(t: Array, theta: Array) -> float:
    """ω̇ [rad/s²] from first and last third of the plateau."""
    third = max(t.size // 3, 2)
    first = (theta[third] - theta[0]) / (t[third] - t[0])
    last = (theta[-1] - theta[-1 - third]) / (t[-1] - t[-1 - third])
    return float((last - first) / (t[-1] - t[0]) * 1.5)


def _edges(theta: Array, t: Array) -> list[int]:
    """Rows that cut the plateau into pieces of whole turns, each at least PIECE long; the last takes what is left."""
    way = 1.0 if theta[-1] > theta[0] else -1.0
    progress = np.maximum.accumulate(way * (theta - theta[0]))
    turns = max(round(float(progress[-1]) / TURN), 1)
    each = max(int(np.ceil(PIECE * turns / (t[-1] - t[0]) - 1e-9)), 1)
    count = max(turns // each, 1)
    inner = np.searchsorted(progress, TURN * each * np.arange(1, count))
    return [0, *map(int, inner), theta.size]


def _pieces(y: Array, edges: list[int]) -> Array:
    return np.array([np.mean(y[a:b]) for a, b in pairwise(edges)])


def _scatter(pieces: Array) -> float:
    return float(np.std(pieces, ddof=1)) if pieces.size > 1 else float("nan")


def variances(scatter: Sequence[float], pieces: Sequence[int], duration: Sequence[float]) -> Array:
    """Variance of each plateau's mean: noise of one density in all of them, pooled over their pieces, over duration."""
    s, n, T = np.asarray(scatter), np.asarray(pieces, dtype=float), np.asarray(duration)
    known = np.isfinite(s) & (n > 1)
    if not known.any():
        return np.full(T.size, np.nan)
    density = np.sum((n[known] - 1) * s[known] ** 2 * T[known] / n[known]) / np.sum(n[known] - 1)
    return np.asarray(density / T)
