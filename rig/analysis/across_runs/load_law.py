"""What a load sweep says as a whole: peak to peak against load, its law, and up against down."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.intervals import Ranged, t95
from rig.analysis.findings.result import Array

SHAPES = 400  # trial values of T_c
SHORTEST, LONGEST = 0.05, 5.0  # of the largest load: T_c outside is a step, or a straight line
LEAST = 5  # runs: three numbers are fitted, two runs more say how sure they are


@dataclass(frozen=True)
class LoadRun:
    """One slow run: `load` N·m, peak to peak arcsec, whether on the way down."""

    load: float
    peak_to_peak: float
    down: bool


@dataclass(frozen=True)
class LoadLaw:
    """P(T) = P_∞ + (P_0 − P_∞)·exp(−|T|/T_c), fitted to all runs; `rms` arcsec is what it leaves."""

    P_0: Ranged  # arcsec, without load
    P_inf: Ranged  # arcsec, under a heavy one
    T_c: Ranged  # N·m; up to LONGEST of the largest load where no level is seen
    rms: float

    @property
    def falls(self) -> bool:
        """Whether the load makes a difference that is told from none."""
        return self.P_0.low > self.P_inf.high or self.P_0.high < self.P_inf.low


def load_law(runs: Sequence[LoadRun]) -> LoadLaw | None:
    """Least squares; intervals are what of each number is left when χ² may rise by what 95 % allow (profile).

    None with fewer than five runs or four loads.
    """
    load = np.abs(np.array([r.load for r in runs]))
    size = np.array([r.peak_to_peak for r in runs])
    if size.size < LEAST or np.unique(load).size < 4:
        return None
    most, dof = float(load.max()), size.size - 3
    shapes = np.geomspace(SHORTEST * most, LONGEST * most, SHAPES)
    ends, own, squares = _straight(load, size, shapes)
    best, variance = int(np.argmin(squares)), float(squares.min()) / dof
    inside = np.flatnonzero(squares <= squares.min() + t95(dof) ** 2 * variance)
    inside = np.arange(max(inside[0] - 1, 0), min(inside[-1] + 2, SHAPES))  # to the trial value beyond either end
    half = t95(dof) * np.sqrt(variance * own[inside])
    low, high = (ends[inside] - half).min(axis=0), (ends[inside] + half).max(axis=0)
    P_0, P_inf = (Ranged(float(ends[best, k]), float(low[k]), float(high[k])) for k in (0, 1))
    T_c = Ranged(float(shapes[best]), float(shapes[inside[0]]), float(shapes[inside[-1]]))
    return LoadLaw(P_0, P_inf, T_c, float(np.sqrt(squares.min() / size.size)))


def down_less_up(runs: Sequence[LoadRun]) -> Ranged | None:
    """Mean over the loads that were run both ways, arcsec; None with fewer than three of them."""
    loads = sorted({r.load for r in runs if r.down} & {r.load for r in runs if not r.down})
    if len(loads) < 3:
        return None

    def mean(load: float, down: bool) -> float:
        return float(np.mean([r.peak_to_peak for r in runs if r.load == load and r.down == down]))

    apart = np.array([mean(load, True) - mean(load, False) for load in loads])
    half = t95(apart.size - 1) * float(apart.std(ddof=1)) / np.sqrt(apart.size)
    return Ranged(float(apart.mean()), float(apart.mean() - half), float(apart.mean() + half))


def _straight(load: Array, size: Array, shapes: Array) -> tuple[Array, Array, Array]:
    """(P_0, P_∞) at every given T_c, their variances over that of a run, both (s, 2), and the squares left (s,)."""
    first = np.exp(-load / shapes[:, None])
    second = 1.0 - first
    a, b, d = np.sum(first**2, axis=1), np.sum(first * second, axis=1), np.sum(second**2, axis=1)
    y, z, det = first @ size, second @ size, a * d - b * b
    ends = np.stack(((d * y - b * z) / det, (a * z - b * y) / det), axis=1)
    left = size - first * ends[:, :1] - second * ends[:, 1:]
    return ends, np.stack((d / det, a / det), axis=1), np.sum(left**2, axis=1)
