"""Mean torques of every stretch at one speed: what friction and damping of both sides are found from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.identify.recording import Plateau
from rig.core.units import TURN
from rig.model.fourier import FourierSeries

PIECE = 1.0  # s at least, in whole turns: longer than friction remembers (0.3 s on the twin)
MOST = 0.5  # correlation of neighbouring pieces at most: what wanders slower than that is no noise of a piece

Edges = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Sides:
    """Inertia and drag of either side as far as they are known: what a change of speed within a stretch takes, SI."""

    J_m: float = 0.0
    B: float = 0.0  # B_m + B_ml·(1 + σ/N)²
    J_l: float = 0.0
    B_l: float = 0.0

    def all_at_motor(self, ratio: float) -> tuple[float, float]:
        """(J, B) of the whole rig seen from the motor."""
        return self.J_m + self.J_l / ratio**2, self.B + self.B_l / ratio**2


@dataclass(frozen=True)
class Torque:
    """One mean torque, N·m, NaN without what it takes; `pieces`: the same for each piece, as if at the mean speed."""

    mean: float
    pieces: Array


@dataclass(frozen=True)
class Mean:
    """One stretch, SI. Motor: what drives it less what the load takes; load: what the gear and the weight give."""

    run: str
    omega: float  # rad/s of the motor
    duration: float  # s
    motor_side: Torque  # of τ_m − τ_l·(1/N − θ̃_p′) − J_m·ω̇_m
    load_side: Torque  # of τ_l + τ_ext − J_l·ω̇_l
    all_sides: Torque  # of τ_m − J·ω̇_m, all that the rig rubs
    begin: float  # s, when it began
    tau_ext: float

    @property
    def way(self) -> float:
        """±1"""
        return float(np.sign(self.omega))

    @property
    def motor(self) -> float:
        """N·m"""
        return self.motor_side.mean

    @property
    def load(self) -> float:
        """N·m"""
        return self.load_side.mean

    @property
    def total(self) -> float:
        """N·m"""
        return self.all_sides.mean


def mean_of(plateau: Plateau, series: FourierSeries, sides: Sides) -> Mean:
    """The stretch's means; `series` gives the lever of the shaft torque at the motor."""
    run, part = plateau.run, slice(plateau.lo, plateau.hi)
    t, theta = run.t[part], run.theta_m[part]
    nothing = np.full(theta.size, np.nan)
    tau_l = nothing if run.tau_l is None else run.tau_l[part]
    tau_m = nothing if run.tau_m is None else run.tau_m[part]
    edges = _edges(theta, t)
    pace = _Pace(t, theta, edges)
    motor = pace.torque(tau_m - tau_l * (1.0 / run.ratio - series.slope(theta)), sides.J_m, sides.B)
    load = pace.torque(tau_l + run.tau_ext, sides.J_l / run.ratio, sides.B_l / run.ratio)
    total = pace.torque(tau_m, *sides.all_at_motor(run.ratio))
    return Mean(run.name, plateau.omega, plateau.duration, motor, load, total, float(t[0]), run.tau_ext)


class _Pace:
    """How the speed went from piece to piece of one stretch."""

    def __init__(self, t: Array, theta: Array, edges: Edges) -> None:
        self.edges, ends = edges, np.minimum(edges, theta.size - 1)
        self.lasts = np.diff(t[ends])
        self.speeds = np.diff(theta[ends]) / self.lasts
        self.overall = float((theta[-1] - theta[0]) / (t[-1] - t[0]))
        self.at_edges = _speed_at(t, theta, ends)

    def torque(self, y: Array, J: float, B: float) -> Torque:
        """`y` (n,) less what `J` takes; its pieces also less what `B` makes of their own speed."""
        made = J * np.diff(self.at_edges) / self.lasts
        sums = np.add.reduceat(y, self.edges[:-1]) / np.diff(self.edges)
        whole = J * float(self.at_edges[-1] - self.at_edges[0]) / float(self.lasts.sum())
        return Torque(float(np.mean(y)) - whole, sums - made - B * (self.speeds - self.overall))


def _speed_at(t: Array, theta: Array, at: Edges) -> Array:
    """ω_m [rad/s] at the rows `at` over a turn about each: what repeats with the angle is averaged out."""
    progress = np.maximum.accumulate(np.sign(theta[-1] - theta[0]) * (theta - theta[0]))
    before = np.searchsorted(progress, progress[at] - 0.5 * TURN)
    after = np.minimum(np.searchsorted(progress, progress[at] + 0.5 * TURN), t.size - 1)
    return np.asarray((theta[after] - theta[before]) / np.maximum(t[after] - t[before], 1e-9))


def _edges(theta: Array, t: Array) -> Edges:
    """Rows that cut the stretch into pieces of whole turns, each at least PIECE long; the last takes what is left."""
    way = 1.0 if theta[-1] > theta[0] else -1.0
    progress = np.maximum.accumulate(way * (theta - theta[0]))
    turns = max(round(float(progress[-1]) / TURN), 1)
    each = max(int(np.ceil(PIECE * turns / (t[-1] - t[0]) - 1e-9)), 1)
    count = max(turns // each, 1)
    inner = np.searchsorted(progress, TURN * each * np.arange(1, count))
    return np.array([0, *inner, theta.size], dtype=np.int64)


def variances(pieces: Sequence[Array], duration: Sequence[float]) -> Array:
    """Variance of each stretch's mean: noise of one density in all of them, from how their pieces scatter.

    Neighbouring pieces that go together make a mean less certain than their scatter says: 1 + 2·ρ of it.
    """
    T = np.asarray(duration)
    known = [(p - p.mean(), length) for p, length in zip(pieces, T, strict=True) if p.size > 1 and np.isfinite(p).all()]
    if not known:
        return np.full(T.size, np.nan)
    free = sum(p.size - 1 for p, _ in known)
    scaled = [p * np.sqrt(length / p.size) for p, length in known]  # to a piece of 1 s
    density = sum(float(p @ p) for p in scaled) / free
    return np.asarray(density * (1.0 + 2.0 * _neighbours(scaled, density)) / T)


def _neighbours(scaled: Sequence[Array], variance: float) -> float:
    """ρ of neighbouring pieces, 0 to MOST; the bias of having taken off each stretch's own mean is put back."""
    pairs = sum(p.size - 1 for p in scaled)
    product = sum(float(p[1:] @ p[:-1]) for p in scaled)
    bias = sum((p.size - 1) / p.size for p in scaled) * variance
    return float(np.clip((product + bias) / max(pairs * variance, 1e-300), 0.0, MOST))
