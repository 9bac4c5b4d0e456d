"""The scatter of a run that was not repeated: one turn against the next, one stroke against the next of its way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.common_orders import without_common_orders
from rig.analysis.tracing.floor.repeats import Scatter, autocorrelation, beside_a_row, compare, freedom
from rig.analysis.tracing.runs.strokes import strokes
from rig.analysis.tracing.thresholds import FLOOR_LEAST
from rig.core.units import TURN
from rig.model.effect import Array

FEW = 25  # rows to compare: fewer have no spread worth the name
# times its roughness, RMS of what is white before the low-pass: 2.1 to 4.7 in 60 runs of five clean campaigns, and ten
# to forty of an error that comes and goes within a second or two, whenever it likes
WHITE = 6.0


def neighbours(eq: Equations, e: Mapping[Key, Array], key: Key) -> Scatter | None:
    """One turn against the next, or one stroke against the next of its direction, of a single run."""
    if key not in e:
        return None
    theta = eq.rows[key].theta_m
    parts = strokes(theta)
    if len(parts) < 3:
        return turn_by_turn(eq, e, key)
    return _scatter(
        eq, key, [compare(theta[a], e[key][a], theta[b], e[key][b]) for a, b in zip(parts, parts[2:], strict=False)]
    )


def turn_by_turn(eq: Equations, e: Mapping[Key, Array], key: Key) -> Scatter | None:
    """Every turn of a single run against those before and after it: where one way is gone once, or on either side of
    where it began, as one cycle about zero goes."""
    if key not in e:
        return None
    theta = eq.rows[key].theta_m
    return _scatter(eq, key, [against_both(theta[p], e[key][p]) for p in strokes(theta)])


def _scatter(eq: Equations, key: Key, made: Sequence[Array]) -> Scatter | None:
    """Of the differences of all parts, each about its own mean."""
    d = np.concatenate([np.zeros(0), *(d - d.mean() for d in made if d.size)])
    if d.size < FLOOR_LEAST / 4:
        return None
    whole = rms = float(np.sqrt(np.mean(d**2)))
    run = eq.runs[key[0]]
    if key[1] == "A" and not run.locked:  # whose noise is the sensors': what goes slowly there is missing, no noise
        rms = min(rms, max(WHITE * roughness(d), float(np.hypot(run.step_m / run.ratio, run.step_l))))
    return Scatter((key[0], key[0]), rms, d.size, 0.0, autocorrelation(d), freedom(d), whole / max(rms, 1e-300))


def roughness(d: Array) -> float:
    """RMS of white noise that would make the rows of `d` (n,) as rough as half of them are: a jump, or what goes
    slowly, adds nothing."""
    return float(np.median(np.abs(np.diff(d, 4))) / 0.6745 / np.sqrt(70))


def against_both(theta: Array, e: Array) -> Array:
    """Differences of every row of one stroke to the mean of a motor turn before and one after, as if of one run; (n,).

    What the output or the load does within a motor turn is nearly straight, and goes out.
    """
    e = without_common_orders(theta, e)
    x = np.maximum.accumulate(np.abs(theta - theta[0])) if theta.size else theta
    inside = (x > TURN) & (x < x[-1:].sum() - TURN)
    inside &= beside_a_row(x - TURN, x) & beside_a_row(x + TURN, x) if x.size > 1 else False
    at = x[inside]
    if at.size <= FEW:
        return np.zeros(0)
    both = 0.5 * (np.interp(at - TURN, x, e) + np.interp(at + TURN, x, e))
    d = e[inside] - both
    rho = float(np.clip(d[1:] @ d[:-1] / max(d @ d, 1e-300), 0.0, 1.0))
    # interpolation between two rows of correlation rho leaves 2/3 + rho/3 of their variance, the mean of two half of it
    return np.asarray(d / np.sqrt(1 + (2 / 3 + rho / 3) / 2))
