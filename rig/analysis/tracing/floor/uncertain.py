"""What the fit itself does not know is not held against unseen runs.

Without a load encoder the orders of the kinematic error are known by the torques they cause at speed alone, far worse
than runs repeat. They are all that θ̃ is over the few degrees that a locked motor turns, and under load their slope is
the lever by which the torque reaches the motor. And where all runs turn at one speed the motor's inertia shows at
reversals alone, whose rows are not fitted. What their own uncertainty allows there is no residual.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import INDEX, ORDERS
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.fit.model import Design, Solution, inverse
from rig.model.effect import Array

PIECES: Final = 50  # of a run that its floor counts as independent: its rows follow one another too closely
SERIES: Final = [INDEX[f"{part}{n}"] for part in "ab" for n in range(1, ORDERS + 1)]
INERTIA: Final = [INDEX["J_m"]]


def is_inferred(eq: Equations, key: Key) -> bool:
    """Whether a block of a run whose load angle nobody read leans on the orders of θ̃_p: the kinematic error of a lock
    test, or the motor's torque."""
    run, channel = key
    leans = channel == "M" or (channel == "A" and eq.runs[run].locked)
    return leans and "theta_l" not in eq.runs[run].has


def of_the_inertia(s: Solution) -> Array:
    """What is known of the coefficients (p, p), rougher than `scatter`, but most campaigns have reversals, and that one
    takes all rows; of the motor's inertia as much less as sensor noise is more of its column than acceleration is: of
    a slow motor it comes out several times too small."""
    known, d, (at,) = inverse(s.gram), s.design, INERTIA
    noise = 0.0
    for (run, c), parts in d.parts.items():
        spoilt, where = parts[0].spoilt, np.flatnonzero(parts[0].at == at)
        if spoilt is not None and where.size:
            column = spoilt.times((parts[0].at == at).astype(float))
            noise += d.eq.noise.weight(c) * d.eq.stands_for.get((run, c), 0.0) * float(column @ column)
    known[at, at] += (s.x[at] * noise * known[at, at]) ** 2
    return known


def beside(e: Array, d: Design, key: Key, covariance: Array, floor: float) -> Array:
    """What is left of `e` (n,) when the orders of θ̃_p, or the motor's inertia at reversals, may move as their
    `covariance` (p, p) lets them: the ridge of Bayes with a floor of `floor`."""
    baseline = d.parts[key][0]
    free = INERTIA if key[1] == "R" else SERIES
    mine = [i for i, at in enumerate(baseline.at) if at in free]
    columns = np.asarray(baseline.z.whole(), dtype=np.float64)[:, mine]
    columns = columns - columns.mean(0)
    prior = covariance[np.ix_(baseline.at[mine], baseline.at[mine])]
    weight = min(PIECES, e.size) / (e.size * floor**2)
    # sensor noise taken off can leave a covariance below zero somewhere: nothing moves there
    sizes, axes = np.linalg.eigh(prior)
    freely = columns @ (axes * np.sqrt(np.maximum(sizes, 0.0)))
    moved = np.linalg.solve(np.eye(len(mine)) + weight * freely.T @ freely, weight * freely.T @ e)
    return np.asarray(e - freely @ moved)
