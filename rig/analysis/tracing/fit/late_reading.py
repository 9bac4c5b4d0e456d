"""A motor torque that is told before it acts, or after, beside an inertia.

A servo that holds what it asks for over a cycle of 1 ms is read half a cycle late. At constant torque that shows
nowhere. But a position loop answers a speed with −k·ω, so that what half a millisecond makes of its torque is
−k·ω̇·0.5 ms: an inertia, of which a motor side seems to have 2 to 3 % too much. What of it is no inertia is how far a
loop's own filters are behind.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.covariance import covariance, is_sure
from rig.analysis.tracing.fit.equations import Bare, Key
from rig.analysis.tracing.fit.model import UNSEEN, Design, Part, Solution, solve
from rig.analysis.tracing.fit.rows import joined, later_by_a_second
from rig.core.quantiles import Z95
from rig.model.effect import Array

NAME: Final = "lag_m"
LEAST: Final = 2e-5  # s; less is the jitter of a loop
MOST: Final = 1e-3  # s, a cycle of a drive; what is later is left to be found
SURE: Final = 4.0  # times half its 95 % interval
HALF_A_CYCLE: Final = 5e-4  # s, how late or early a reading may well be before anything is known of it
HARDLY: Final = 5e-3  # relative, of the inertia: what moves it by less is what slow runs do where they turn back
AS_GOOD: Final = 0.3  # of the delay and of what it moves, half an interval: in two campaigns with a key, servos at
# 1 kHz and order 2 at up to 13 Hz, the inertia was moved by 0.2 and 0.3 too much


def is_late(s: Solution) -> bool:
    """Whether a delay of the motor torque's reading, which `s` has a column of, is sure and as short as a drive's."""
    return is_sure(s, NAME, LEAST, SURE) and abs(s.value(NAME)) < MOST


def beside_a_late_reading(s: Solution) -> tuple[Solution, Array]:
    """The solution beside that delay where it is sure and matters, as it is where not; and what is to be added to its
    covariance (p, p) for a delay that is known so well, or for an inertia that would be another one beside it."""
    nothing = np.zeros_like(s.gram)
    if s.gram[INDEX[NAME], INDEX[NAME]] > UNSEEN or s.gram[INDEX["J_m"], INDEX["J_m"]] <= UNSEEN:
        return s, nothing
    late = _beside(s)
    by = _with_each_second(late)
    size, half = abs(late.value(NAME)), Z95 * float(np.sqrt(max(covariance(late)[INDEX[NAME], INDEX[NAME]], 0.0)))
    moves = abs(by[INDEX["J_m"]]) * size > HARDLY * abs(late.value("J_m"))
    if moves and max(LEAST, SURE * half) < size < MOST:
        return late, np.outer(by, by) * (AS_GOOD * size / Z95) ** 2
    half = min(half + size, HALF_A_CYCLE)
    by[INDEX[NAME]] = 0.0
    return s, np.outer(by, by) * (half / Z95) ** 2


def _with_each_second(late: Solution) -> Array:
    """How all coefficients change with that delay, by one second of it, (p,): the others are fitted again."""
    at = INDEX[NAME]
    others = np.setdiff1d(np.arange(late.x.size), [at])
    out = np.zeros(late.x.size)
    out[at] = 1.0
    out[others] = -solve(late.gram[np.ix_(others, others)], late.gram[others, at])
    return out


def _beside(s: Solution) -> Solution:
    """Fitted again with a column more in every run whose torque and time were read."""
    d, at = s.design, INDEX[NAME]
    gram, right, parts = s.gram.copy(), s.right.copy(), dict(d.parts)
    for key in s.keys:
        if key[1] not in "MR" or not d.eq.runs[key[0]].has >= {"t", "tau_m"}:
            continue
        z = _column(d, key)
        weight = d.eq.noise.weight(key[1])
        for part in d.parts[key]:
            across = weight * part.z.onto(z)[:, 0]
            gram[part.at, at] += across
            gram[at, part.at] += across
        gram[at, at] += weight * float(z[:, 0] @ z[:, 0])
        right[at] += weight * float(z[:, 0] @ d.y[key])
        parts[key] = (*parts[key], Part(Bare(z), np.array([at]), None))
    gram[at, at] += 1 / HALF_A_CYCLE**2
    more = gram - s.gram
    made = replace(d, parts=parts, gram=d.gram + more, right=d.right + right - s.right)
    return Solution(solve(gram, right), gram, right, made, s.keys)


def _column(d: Design, key: Key) -> Array:
    """−τ̇_m of a block, pieces joined, without what the run has to itself, (n, 1)."""
    run, rows = d.eq.runs[key[0]], d.eq.rows[key]
    late = joined(later_by_a_second(run, key[1]))[rows.keep]
    return d.eq.bare(key, np.nan_to_num(late))[:, None]
