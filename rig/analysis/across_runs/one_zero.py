"""Has the motor's encoder kept its zero between two sessions? The turn of a sign-and-scale proof shows it."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Source, motion_of
from rig.analysis.orders.align import Alignment, Complex, align
from rig.analysis.orders.sums import harmonics
from rig.core.quantiles import Z95
from rig.core.units import RPM, TURN
from rig.model.fourier import FourierSeries
from rig.model.transmission_error import transmission_error

ORDERS = 6  # of one turn: higher ones are below the noise of a turn
PARTS = 12  # of a way: their scatter says how sure the orders are
MOVING = 3.0 * RPM  # rad/s: slower rows are the corners of the turn, where friction changes sides and the gear unwinds
ENOUGH = 0.8  # of a turn has to be left for each way
TRUSTED = 4  # orders that vote on the shift


def zero_between(turn: Source, slow: FourierSeries) -> Alignment | None:
    """By how far the motor encoder's zero of `turn`, a proof's run, lies from that of the run `slow` was found from.

    None when the run holds no slow turn each way, or no order stands out of its noise.
    """
    found = _orders(turn)
    k = min(ORDERS, len(slow.a))
    if found is None or k < 1:
        return None
    seen, u = found
    expected = np.array(slow.a[:k]) - 1j * np.array(slow.b[:k])
    return align(seen[:k], expected, u[:k], min(TRUSTED, k))


def shown_common(where: Alignment | None) -> bool:
    """Whether the zero is shown to be the same: found, near 0, and as near as it is sure."""
    return where is not None and where.common and not where.odd


def _orders(run: Source) -> tuple[Complex, Array] | None:
    """Phasors a_n − j·b_n of θ̃ [rad] and 1 σ of a part of each, both (ORDERS,), from the rows that turn."""
    motion = motion_of(run)
    if motion is None or motion.theta_l is None or motion.t is None or motion.theta_m.size < 200:
        return None
    speed = _speed(motion.theta_m, motion.t)
    ways = [np.flatnonzero(sign * speed > MOVING) for sign in (1.0, -1.0)]
    if any(way.size < 10 * PARTS or np.ptp(motion.theta_m[way]) < ENOUGH * TURN for way in ways):
        return None
    error = transmission_error(motion.theta_m, motion.theta_l, motion.ratio)
    parts = [(_columns(motion.theta_m[rows], k), error[rows])
             for k, way in enumerate(ways) for rows in np.array_split(way, PARTS)]  # fmt: skip
    c, u = _fitted(np.array([x @ x.T for x, _ in parts]), np.array([x @ y for x, y in parts]))
    a, b = slice(0, ORDERS), slice(ORDERS, 2 * ORDERS)
    return np.asarray(c[a] - 1j * c[b]), np.asarray(np.sqrt(0.5 * (u[a] ** 2 + u[b] ** 2)))


def _columns(theta: Array, way: int) -> Array:
    """cos nθ, sin nθ, and a level of its own for each way: (2·ORDERS + 2, rows)."""
    level = np.zeros((2, theta.size))
    level[way] = 1.0
    return np.vstack((harmonics(theta, ORDERS), level))


def _fitted(grams: Array, moments: Array) -> tuple[Array, Array]:
    """Coefficients of all parts, and 1 σ of each by leaving out a part at a time; from their sums (m, p, p), (m, p)."""
    gram, moment, n = grams.sum(axis=0), moments.sum(axis=0), len(grams)
    left = np.linalg.solve(gram - grams, (moment - moments)[:, :, None])[:, :, 0]
    spread = np.sum((left - left.mean(axis=0)) ** 2, axis=0)
    return np.linalg.solve(gram, moment), np.asarray(t95(n - 1) / Z95 * np.sqrt((n - 1) / n * spread))


def _speed(theta: Array, t: Array) -> Array:
    """rad/s over 0.1 s: a count of the motor's encoder is then a 250th of what 15 rpm make of it."""
    rows = max(round(0.05 / float(np.median(np.diff(t)))), 1)
    ahead, behind = np.minimum(np.arange(t.size) + rows, t.size - 1), np.maximum(np.arange(t.size) - rows, 0)
    return np.asarray((theta[ahead] - theta[behind]) / np.maximum(t[ahead] - t[behind], 1e-9))
