"""A spring law and the loop around it, fitted together to the points of all ramps."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.stiffness.laws import Law, Line, Scale
from rig.analysis.stiffness.points import Points, rates_differ
from rig.analysis.stiffness.shape import Shape

PULL = 1e-4  # what the run says nothing of stays where it was: weight of that, a point of full torque being 1
STEP = 1e-5  # of the parameters, for slopes


@dataclass(frozen=True)
class Curve:
    """τ = f(w − w_0) + d·(h·s(x) + B·|ẇ|), d the direction, x the way since the last turn

    f is the spring, h the half width of the loop once it has opened, s its shape, B what widens it with the rate.
    """

    law: Law
    scale: Scale
    shape: Shape
    p: Array  # parameters of the law
    middle: float  # rad, w_0
    half_width: float  # N·m, h
    viscous: float  # N·m·s/rad at the output, B; 0 where all ramps have one rate
    rms: float = float("nan")  # N·m, of the points

    def torque(self, windup: Array) -> Array:
        """The spring alone [N·m]."""
        return self.law.torque(windup - self.middle, self.p, self.scale)

    def tangent(self, windup: Array) -> Array:
        """The spring's slope [N·m/rad]."""
        return self.law.tangent(windup - self.middle, self.p, self.scale)

    def predicted(self, points: Points) -> Array:
        """With the loop."""
        loop = points.direction * (self.half_width * self.shape.opened(points.gone) + self.viscous * points.rate)
        return np.asarray(self.torque(points.windup) + loop)


def scale_of(points: Points) -> Scale:
    """Secant stiffness and half of the wind-up."""
    x = points.windup - points.windup.mean()
    return Scale(float(x @ (points.tau - points.tau.mean())) / float(x @ x), points.reach)


class Problem:
    """The parameters x of a Curve as numbers of order one, and how far it misses `points` with them."""

    def __init__(self, law: Law, points: Points, scale: Scale, shape: Shape) -> None:
        self.law, self.points, self.scale, self.shape = law, points, scale, shape
        self.fastest = float(np.percentile(points.rate, 90)) if rates_differ(points) else 0.0  # 0: B cannot be told
        self.both = bool(np.ptp(points.direction) > 0)
        self.middle = float(points.windup.mean() - points.tau.mean() / scale.K)

    def pack(self, curve: Curve) -> Array:
        """x of a curve."""
        torque = self.scale.torque
        shift = (curve.middle - self.middle) / self.scale.reach
        return np.array([shift, curve.half_width / torque, curve.viscous * self.fastest / torque, *curve.p])

    def unpack(self, x: Array) -> Curve:
        """The curve of x."""
        viscous = float(x[2]) * self.scale.torque / self.fastest if self.fastest else 0.0
        middle = self.middle + float(x[0]) * self.scale.reach
        return Curve(self.law, self.scale, self.shape, x[3:], middle, float(x[1]) * self.scale.torque, viscous)

    def misfit(self, x: Array) -> Array:
        """Of every point, over the largest torque; then what keeps in place the parameters that no point holds."""
        rest = (self.unpack(x).predicted(self.points) - self.points.tau) / self.scale.torque
        return np.concatenate((rest, [0.0 if self.fastest else x[2], 0.0 if self.both else x[1]], PULL * (x[3:] - 1.0)))

    def slopes(self, x: Array) -> Array:
        """d misfit / dx, central differences, (p + pulls, m)."""
        steps = np.eye(x.size) * STEP
        return np.stack([(self.misfit(x + s) - self.misfit(x - s)) / (2 * STEP) for s in steps], axis=1)


def fit(law: Law, points: Points, scale: Scale, shape: Shape, start: Curve | None = None) -> Curve:
    """Least squares over all points, each of equal weight; from `start` when a fit of the same law is known."""
    from scipy.optimize import least_squares  # loaded where there is a spring to fit: most analyses have none

    problem = Problem(law, points, scale, shape)
    if start is not None:
        begins = [problem.pack(start)]
    else:
        first = Curve(Line(), scale, shape, np.ones(1), problem.middle, _half_width(points, scale), 0.0)
        begins = [np.append(problem.pack(first)[:3], p) for p in law.starts()]
    found = [least_squares(problem.misfit, x, jac=problem.slopes, max_nfev=40) for x in begins]
    curve = problem.unpack(np.asarray(min(found, key=lambda f: float(f.cost)).x))
    return replace(curve, rms=float(np.sqrt(np.mean((curve.predicted(points) - points.tau) ** 2))))


def without(curve: Curve, points: Points, kept: list[npt.NDArray[np.bool_]]) -> list[Curve]:
    """The curve refitted to each of `kept` (p,) by one Gauss-Newton step, which is all a small part left out takes."""
    problem = Problem(curve.law, points, curve.scale, curve.shape)
    x = problem.pack(curve)
    rest, slopes = problem.misfit(x), problem.slopes(x)
    out = []
    for keep in kept:
        rows = np.append(keep, np.full(rest.size - keep.size, True))
        step = np.linalg.lstsq(slopes[rows], -rest[rows], rcond=1e-9)[0]
        out.append(problem.unpack(x + step))
    return out


def _half_width(points: Points, scale: Scale) -> float:
    """A first guess: what the direction adds to a line, in the middle of the range [N·m]."""
    inner = np.abs(points.windup - points.windup.mean()) < 0.5 * points.reach
    design = np.stack((points.windup[inner], np.ones(inner.sum()), points.direction[inner]), axis=1)
    if inner.sum() < 8 or np.ptp(points.direction[inner]) == 0:
        return 0.0
    scaled = np.array([scale.reach, 1.0, 1.0])
    return float(np.linalg.lstsq(design / scaled, points.tau[inner], rcond=None)[0][2])
