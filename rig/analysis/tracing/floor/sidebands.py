"""What a vibration that swells, fades or wanders has beside the lines that all runs share: lines of single runs.

A run of 400 s resolves what one of 30 s has in a single line, and no two runs swell at the same time. What is left
there is no effect: a second resonance would take it on, for it moves the load in proportion to the torque.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.equations import Equations, Key, Term
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.floor.spectrum import on_even_grid, over_usual
from rig.analysis.tracing.thresholds import LINE
from rig.model.effect import Array
from rig.model.effects import EACH_RUN

MOST = 12  # of one run
NEAR = 1.0  # Hz from a line of all runs: what swells faster than once a second is no slow swell
HIGHEST = 30.0  # order that a ripple has: of a slow motor every frequency is near one
RESOLVED = 2.0  # turns of phase in a run by which a line has left another
UNEVEN = 3e-3  # of an order's frequency, as a position loop holds the speed
FINER = 40  # parts of what a run resolves: an eightieth of a turn of phase from its middle to its ends


def sidebands(eq: Equations, e: Mapping[Key, Array], hz: Sequence[float]) -> dict[Key, Array]:
    """Cosine and sine of every such line in the blocks of each run (n, 2q), of the residuals `e` of all runs that the
    lines at `hz` have not been taken from."""
    sensor = "L" if any(c == "L" for _, c in e) else "A"
    found: dict[Key, Array] = {}
    for run in sorted({i for i, c in e if c == sensor}):
        own = _of_a_run(eq, (run, sensor), e[run, sensor], hz)
        columns = [_columns(eq, run, one) for one in own]
        for c in columns[0] if columns else ():
            found[run, c] = np.hstack([made[c] for made in columns])
    return found


def _columns(eq: Equations, run: int, hz: float) -> dict[str, Array]:
    """Of one line in the channels of a run (n, 2)."""
    return {c: m for c, m in eq.term(run, Term(EACH_RUN["external_vibration"], (hz,))).items() if np.any(m)}


def _of_a_run(eq: Equations, key: Key, e: Array, hz: Sequence[float]) -> list[float]:
    """Hz of the lines beside those at `hz`, the loudest first."""
    t, turning, found = clock(eq, key), eq.runs[key[0]].turning / (2 * np.pi), list[float]()
    z = np.hstack([np.ones((e.size, 1)), *(_columns(eq, key[0], one)[key[1]] for one in hz)])
    while len(found) < MOST:
        left = e - z @ np.linalg.lstsq(z, e, rcond=None)[0]
        grid, heights = over_usual(*on_even_grid(t, left)[:2])
        near = (np.min(np.abs(np.subtract.outer(grid, hz)), axis=1) < NEAR) & ~_of_the_motor(grid, turning, t)
        if not near.any() or heights[near].max() < LINE:
            break
        one = _sharpened(t, left, float(grid[near][np.argmax(heights[near])]))
        found.append(one)
        z = np.hstack([z, _columns(eq, key[0], one)[key[1]]])
    return found


def _of_the_motor(grid: Array, turning: float, t: Array) -> npt.NDArray[np.bool_]:
    """Where whole orders of a motor stand that turns `turning` times a second: a ripple is no part of a vibration."""
    wide = np.maximum(RESOLVED / float(t[-1] - t[0]), UNEVEN * grid)
    order = np.clip(np.round(grid / turning), 1.0, HIGHEST)
    return np.asarray(np.abs(grid - turning * order) < np.minimum(wide, turning / 4))


def _sharpened(t: Array, e: Array, about: float) -> float:
    """The frequency that takes most, within what the run resolves."""
    step = 1.0 / (FINER * float(t[-1] - t[0]))
    fine = about + step * np.arange(-FINER // 2, FINER // 2 + 1)
    return float(fine[np.argmax(np.abs(np.exp(-2j * np.pi * np.multiply.outer(fine, t - t.mean())) @ e))])
