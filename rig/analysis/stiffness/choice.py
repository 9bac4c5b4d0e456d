"""Which spring law a run supports: each is judged by points it was not fitted to; and how sure its numbers are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.stiffness.curve import Curve, fit, without
from rig.analysis.stiffness.laws import Law
from rig.analysis.stiffness.points import Points

ZONES = 24  # of the wind-up: neighbouring points share count steps and what the kinematic error leaves, zones hardly
FOLDS = 6  # every sixth zone is left out at a time
SLIGHT = 0.005  # of the stiffness: a bend below it is not spoken of
MATERIAL = 1.1  # a law that misses the left-out points by less than a tenth more is as good


@dataclass(frozen=True)
class Trial:
    """One law: fitted to all points, and how far off it was on those left out."""

    curve: Curve
    squares: Array  # (FOLDS,) mean squared error of each fold, (N·m)²

    @property
    def rms(self) -> float:
        """N·m, of points not fitted to."""
        return float(np.sqrt(self.squares.mean()))


def zones(points: Points) -> npt.NDArray[np.int64]:
    """In which of ZONES equal parts of the wind-up each point lies, (p,)."""
    share = (points.windup - points.windup.min()) / (2 * points.reach)
    return np.asarray(np.minimum((share * ZONES).astype(np.int64), ZONES - 1))


def attempt(law: Law, points: Points, whole: Curve) -> Trial:
    """`law` against every fold; `whole` is its fit to all points."""
    zone, squares = zones(points), np.empty(FOLDS)
    for k in range(FOLDS):
        out = zone % FOLDS == k
        curve = fit(law, points.pick(~out), whole.scale, whole.shape, whole)
        rest = curve.predicted(points.pick(out)) - points.tau[out]
        squares[k] = np.mean(rest**2)
    return Trial(whole, squares)


def simplest(trials: list[Trial]) -> Trial:
    """The first of `trials` (simplest first) that is not worse than the best by a tenth and one standard error."""
    best = min(trials, key=lambda trial: trial.rms)
    for trial in trials:
        more = trial.squares - best.squares
        if trial.rms <= MATERIAL * best.rms or more.mean() <= more.std(ddof=1) / np.sqrt(FOLDS):
            return trial
    return best


@dataclass(frozen=True)
class LeftOut:
    """A curve, and what becomes of it when a part of the points is left out: jackknife      [efron1982]

    One ramp at a time for what changes between ramps, and one zone of the wind-up at a time for what does not: a
    departure from the law that every ramp repeats. Both in quadrature.
    """

    curve: Curve
    by_ramp: list[Curve]
    by_zone: list[Curve]

    def half(self, numbers: Callable[[Curve], Array]) -> Array:
        """Half widths of the 95 % intervals of `numbers(curve)` (m,)."""
        return np.asarray(np.hypot(_jackknife(self.by_ramp, numbers), _jackknife(self.by_zone, numbers)))

    def bends(self, levels: Array) -> bool:
        """Whether the slope at any of `levels` N·m is told from the secant to the last of them."""

        def relative(c: Curve) -> Array:
            u = c.law.windup(levels, c.p, c.scale)
            return np.asarray(c.tangent(c.middle + u) * u[-1] / levels[-1] - 1.0)

        return bool(np.any(np.abs(relative(self.curve)) > np.hypot(self.half(relative), SLIGHT)))


def leave_out(curve: Curve, points: Points) -> LeftOut:
    """Left out in turn: every ramp (of three or more), every zone."""
    ramps, zone = np.unique(points.ramp), zones(points)
    by_ramp = without(curve, points, [points.ramp != k for k in ramps]) if ramps.size > 2 else []
    return LeftOut(curve, by_ramp, without(curve, points, [zone != k for k in np.unique(zone)]))


def _jackknife(curves: list[Curve], numbers: Callable[[Curve], Array]) -> Array:
    n = len(curves)
    if n < 2:
        return np.zeros(1)
    found = np.array([numbers(c) for c in curves])
    return np.asarray(t95(n - 1) * np.sqrt((n - 1) / n * np.sum((found - found.mean(axis=0)) ** 2, axis=0)))
