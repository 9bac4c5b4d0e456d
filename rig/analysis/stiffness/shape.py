"""How the loop opens after a turn, and which points lie where it has opened."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.stiffness.points import Points, rates_differ

WAYS = np.array([0.02, 0.04, 0.08, 0.15, 0.25, 0.4, 0.6, 0.85, 1.2])  # of the reach: from stop to stop, per element
OPEN = 0.96  # what counts as opened
MOST = 1.0  # of the reach: a loop that takes longer leaves no middle where both branches are open; all points then do
LOOP = 5e-4  # of the largest torque: a narrower loop has no shape


@dataclass(frozen=True)
class Shape:
    """s(x) from −1 on one branch to +1 on the other, x rad after the turn: slipping elements in parallel

    s(x) = Σ a_j·(2·min(x/x_j, 1) − 1): a superposition of stops (Prandtl-Ishlinskii), which a Masing spring of any
    kind is, Dahl and Bouc-Wen elements in good approximation      [kuhnen2003]
    """

    ways: Array  # x_j rad, (j,)
    shares: Array  # a_j, (j,), not negative, their sum is 1

    def opened(self, gone: Array) -> Array:
        """s at `gone` rad after a turn, (n,)."""
        return np.asarray((2.0 * np.minimum(np.divide.outer(gone, self.ways), 1.0) - 1.0) @ self.shares)

    @property
    def way(self) -> float:
        """rad after a turn from which the loop is open."""
        x = np.linspace(0.0, float(self.ways.max()), 500)
        return float(x[np.argmax(self.opened(x) >= OPEN)])


def shape_of(points: Points, K: float) -> Shape:
    """Least squares, no element negative, beside a spring of powers to the fifth: bends must not pass for a loop.

    `K` N·m/rad is the secant.
    """
    from scipy.optimize import nnls  # loaded where there is a spring to fit: most analyses have none

    reach = points.reach
    u = (points.windup - points.windup.mean()) / reach
    base = np.stack((np.ones(u.size), u, u**2, u**3, u**5), axis=1)
    if rates_differ(points):  # else what the rate adds is as much on every branch
        base = np.column_stack((base, points.direction * points.rate / points.rate.max()))
    stops = 2.0 * np.minimum(np.divide.outer(points.gone / reach, WAYS), 1.0) - 1.0
    stops = stops * points.direction[:, None]
    rest = np.column_stack((stops, points.tau / (K * reach)))
    rest = rest - base @ np.linalg.lstsq(base, rest, rcond=1e-9)[0]
    shares = nnls(rest[:, :-1], rest[:, -1])[0] if np.ptp(points.direction) > 0 else np.zeros(WAYS.size)
    if shares.sum() < LOOP:
        shares = np.append(1.0, np.zeros(WAYS.size - 1))
    return Shape(WAYS * reach, shares / shares.sum())


def open_points(points: Points, shape: Shape) -> Points:
    """Those where the loop has opened; all of them when it takes too long."""
    return points.pick(points.gone >= shape.way) if shape.way < MOST * points.reach else points
