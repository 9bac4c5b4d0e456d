"""Stairs: counts that are lost again and again, each before the last one's window is over.

The means between two steps come nearest to a run where what a step costs is weighed against what it explains (Potts'
functional, solved exactly)      [friedrich2008]. Stairs draw anything, so that they have to be sharp: lines from the
middle of one step to that of the next, which follow what drifts or waves better, must leave far more.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numba import njit

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.jumps import EDGE, WINDOW
from rig.core.units import TURN
from rig.model.effect import Array

COST: Final = 300.0  # of a step, in squares of what a quiet sixth of a second scatters by
SHORT: Final = WINDOW // 2
QUIET: Final = 0.25  # of such windows
SHORTEST: Final = 2 * EDGE  # rows between two steps: the low-pass spreads each over EDGE
LONGEST: Final = 12_000  # rows of a run: the time it takes goes with their square
SHARP: Final = 1.5  # times the sum of squares that stairs leave, what lines through their middles must leave
LEFT: Final = 0.25  # of a run's sum of squares, the most that stairs may leave
OFTEN: Final = 50  # rows a step, at least: with more of them they draw anything
MOSTLY: Final = 0.75  # of the runs that stairs draw
STEPS: Final = 10  # in all runs together, at least
LEANS: Final = 0.5  # of a usual step, what a run goes on by from one to the next: a line that is drawn by steps has 1
BEFORE: Final = slice(-2 * EDGE, -EDGE)  # rows of what lies between two steps, beyond what the low-pass spreads
AFTER: Final = slice(EDGE, 2 * EDGE)
# of a step, what a run has done of it by then: six runs with waves had 0.36 to 0.43; of 56 with lost counts, in six
# campaigns of the blind generator, one had 0.46 and the others 0.59 and more
AT_ONCE: Final = 0.55
RUNS: Final = 3  # that have two and more
NEAR: Final = 0.01  # rad of the output: steps so near each other are there because of the angle
BY_CHANCE: Final = 3.0  # times what chance makes of such pairs, from which on it is the angle


def stairs(eq: Equations, e: Mapping[Key, Array]) -> dict[int, list[int]]:
    """Rows of A where each run of `e` steps; {} where those are no lost counts: few, as well drawn by lines, or at the
    same angles of the output again and again."""
    found: dict[int, list[int]] = {}
    stepping = 0
    for key in (k for k in e if k[1] == "A" and not eq.runs[k[0]].locked and e[k].size <= LONGEST):
        y = np.ascontiguousarray(e[key] - e[key].mean())
        edges = _edges(y)
        if len(edges) > 2 + y.size / OFTEN:
            return {}
        flat, lines = _left(y, edges)
        if len(edges) > 2 and flat < LEFT * float(y @ y):
            stepping += 1
            if lines > SHARP * flat and not _leans(y, edges) and _at_once(y, edges):
                found[key[0]] = edges[1:-1]
    several = sum(len(steps) > 1 for steps in found.values())
    plain = sum(map(len, found.values())) >= STEPS and several >= RUNS and len(found) >= MOSTLY * stepping
    return found if plain and not _of_the_angle(eq, found) else {}


def _edges(y: Array) -> list[int]:
    """Where the stairs nearest to `y` (n,) begin, step, and end; no step where none could leave so little as LEFT."""
    windows = y[: y.size // SHORT * SHORT].reshape(-1, SHORT)
    # in many windows of such a run there is a step
    usual = float(np.quantile(windows.var(axis=1), QUIET)) if windows.size else np.inf
    if usual > LEFT * y.var():
        return [0, y.size]
    return [int(at) for at in _nearest(y, COST * usual, SHORTEST)]


def _left(y: Array, edges: Sequence[int]) -> tuple[float, float]:
    """Sums of squares that the stairs leave, and lines that meet at both ends and in the middle of every step."""
    flat = np.repeat([y[a:b].mean() for a, b in itertools.pairwise(edges)], np.diff(edges))
    knots = np.array([0.0, *((a + b - 1) / 2 for a, b in itertools.pairwise(edges)), y.size - 1.0])
    hats = np.stack([np.interp(np.arange(y.size), knots, one) for one in np.eye(knots.size)], 1)
    lines = hats @ np.linalg.lstsq(hats, y, rcond=None)[0]
    return float(np.sum((y - flat) ** 2)), float(np.sum((y - lines) ** 2))


def _leans(y: Array, edges: Sequence[int]) -> bool:
    """Whether between its steps `y` (n,) goes on the same way: a slope that now and then falls back is stairs with many
    small steps one way and few large ones back, and as sharp as they."""
    parts = [y[a:b] for a, b in itertools.pairwise(edges)]
    means = np.array([part.mean() for part in parts])
    within = [np.arange(part.size) - (part.size - 1) / 2 for part in parts]
    slope = sum(float(x @ part) for x, part in zip(within, parts, strict=True))
    slope /= sum(float(x @ x) for x in within)
    rise = abs(slope) * float(np.mean([part.size for part in parts]))
    return bool(rise > LEANS * np.median(np.abs(np.diff(means))))


def _at_once(y: Array, edges: Sequence[int]) -> bool:
    """Whether `y` (n,) is, right after its steps, as far from what it was right before as the means between them are: a
    wave that is drawn by steps takes its time."""
    parts = [y[a:b] for a, b in itertools.pairwise(edges)]
    whole = np.diff([part.mean() for part in parts])
    before, after = (np.array([part[which].mean() for part in parts]) for which in (BEFORE, AFTER))
    return bool((after[1:] - before[:-1]) @ whole > AT_ONCE * (whole @ whole))


def _of_the_angle(eq: Equations, found: Mapping[int, Sequence[int]]) -> bool:
    """Whether steps lie at the same angle of the output more often than chance has it, as those of a scale that was put
    together from pieces do: in another run, or in the same one on another way past."""
    theta = {run: eq.rows[run, "A"].theta_m / eq.runs[run].ratio for run in found}
    at = {run: np.mod(theta[run][list(rows)], TURN) for run, rows in found.items()}
    pairs = expected = 0.0
    for a, b in itertools.combinations_with_replacement(found, 2):
        apart = np.abs(at[a][:, None] - at[b])
        near = np.minimum(apart, TURN - apart) < NEAR
        count, seen = (apart.size, near.sum()) if a != b else (apart.size - len(apart), near.sum() - len(apart))
        pairs += seen
        expected += count * 2 * NEAR / max(min(TURN, float(np.ptp(theta[a])), float(np.ptp(theta[b]))), 2 * NEAR)
    return bool(pairs > BY_CHANCE * (1.0 + expected))


@njit(cache=True, nogil=True)
def _nearest(y: Array, cost: float, shortest: int) -> Array:
    """Edges (k,) of the stairs that leave least of `y` (n,) with what each step costs; none is shorter than so many
    rows. Every last step that may be, for every end [friedrich2008]."""
    n = y.size
    total, squares = np.zeros(n + 1), np.zeros(n + 1)
    for i in range(n):
        total[i + 1] = total[i] + y[i]
        squares[i + 1] = squares[i] + y[i] * y[i]
    least, last = np.full(n + 1, np.inf), np.zeros(n + 1, np.int64)
    least[0] = -cost
    for end in range(shortest, n + 1):
        for begin in range(end - shortest + 1):
            so_far = total[end] - total[begin]
            left = least[begin] + cost + squares[end] - squares[begin] - so_far * so_far / (end - begin)
            if left < least[end]:
                least[end] = left
                last[end] = begin
    edges = [n]
    while edges[-1] > 0:
        edges.append(last[edges[-1]])
    return np.array(edges[::-1])
