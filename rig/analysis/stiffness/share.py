"""Does the kinematic error of the slow run fit this one, and how much of it does the loaded gear show?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.stiffness.choice import zones
from rig.analysis.stiffness.curve import Curve, fit
from rig.analysis.stiffness.laws import Cubic, Scale
from rig.analysis.stiffness.points import Points
from rig.analysis.stiffness.shape import Shape

UNDER_LOAD = 0.25  # of the error without load: how far it may differ under load; on the paper's gear it falls to half
STEP = 0.3  # of the share, either side of where it is looked for
WORSE = 1.2  # a reference that leaves this much more scatter than none was taken at another zero of the motor angle


@dataclass(frozen=True)
class Share:
    """How much of the reference's kinematic error this run shows, and the half width of its 95 % interval."""

    value: float
    half: float
    fitted: bool  # else taken for 1


def share_of(points: Points, scale: Scale, shape: Shape) -> Share:
    """Fitted where the run covers enough of the motor turn to tell the error from a cubic spring, else 1 ± 0.25."""
    whole = fit(Cubic(), points, scale, shape)
    near = _best(points, whole, 1.0)
    best = _best(points, whole, near) if np.isfinite(near) else near
    if not 0.1 < best < 1.9:  # nor where no share is the best one
        return Share(1.0, UNDER_LOAD, False)
    zone = zones(points) // 2
    left = np.array([_best(points.pick(zone != k), whole, best) for k in np.unique(zone)])
    n = left.size
    half = t95(n - 1) * float(np.sqrt((n - 1) / n * np.sum((left - left.mean()) ** 2)))
    return Share(best, half, True) if half < UNDER_LOAD else Share(1.0, UNDER_LOAD, False)


def _best(points: Points, start: Curve, near: float) -> float:
    """The share that leaves the least scatter about a cubic spring with its loop: vertex of a parabola through three;
    NaN where it has none.

    What is left is linear in the share, so its square is a parabola but for the few parameters that are not linear.
    """
    shares = (near - STEP, near, near + STEP)
    low, mid, high = (fit(start.law, points.with_share(g), start.scale, start.shape, start).rms ** 2 for g in shares)
    bend = low - 2 * mid + high
    return near + 0.5 * STEP * (low - high) / bend if bend > 0 else float("nan")


def reference_fits(points: Points, scale: Scale, shape: Shape) -> bool:
    """Whether subtracting the reference left no more scatter than there was."""
    with_it, none = (fit(Cubic(), points.with_share(g), scale, shape).rms for g in (1.0, 0.0))
    return with_it <= WORSE * none
