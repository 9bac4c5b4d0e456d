"""Whether orders of the motor that the low-pass takes away stand out in what the model leaves.

A second mode is shaken by the orders of the gear, most where one of them meets it. A mode above the low-pass leaves no
residual in the equations, or no more than a slightly larger inertia would. But an order of the transmission has one
amplitude at every speed, and one of the load encoder is an acceleration that grows with the square of the speed: an
amplitude that does neither is made by a mode.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.channels import ORDERS
from rig.analysis.tracing.fit.equations import Key, unmasked_columns
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.rows import unmasked
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.analysis.tracing.thresholds import RATE
from rig.core.units import TURN
from rig.model.effect import MEASURED, Array
from rig.model.second_mode.shaken import EXCITED

OFTEN: Final = 1.5  # times RATE, the rows of a file that hold more than is compared
WIDER: Final = 1.8  # times the low-pass: as wide as rows at the working rate let it be
FROM: Final = 0.7  # of the low-pass
TO: Final = 0.32  # of the working rate, up to where its rows are as they were read
STEADY: Final = 0.5  # of the mean speed, how far nine tenths of a run may vary
LONG: Final = 10.0  # s of a run: some dozens of turns, whose orders stand well apart
BESIDE: Final = (0.4, 0.5, 0.6)  # orders away from a whole one, where there is only noise
STANDS_OUT: Final = 0.45  # of the floor, RMS of those orders; 16 campaigns in which nothing rings have 0.34 at most
RUNS: Final = 2  # that show it
ITSELF: Final = {"A": 0, "L": 2}  # with which power of the speed an order of a gear or an encoder goes, by channel


@dataclass(frozen=True)
class Line:
    """One order of one run: complex amplitude, rad or N·m, frequency, Hz, and the square of what noise makes of it."""

    run: int
    order: int
    height: complex
    hz: float
    noise: float


def rings_above(s: Solution, floors: Mapping[Key, float]) -> bool:
    """Whether orders above the low-pass differ from speed to speed by half a floor, in some runs."""
    return any(_runs_that_ring(s, floors, channel) >= RUNS for channel in ITSELF)


def _runs_that_ring(s: Solution, floors: Mapping[Key, float], channel: str) -> int:
    runs = s.design.eq.runs
    lines = [line for i, c in s.keys if c == channel and _shows(runs[i]) for line in _lines(s, i, channel)]
    apart = _from_speed_to_speed(lines, ITSELF[channel])
    above = [(line, h) for line, h in zip(lines, apart, strict=True) if line.hz > FROM * _sigma(runs[line.run])]
    loud = 0
    for i in {line.run for line, _ in above}:
        mine = [2.0 * (abs(h) ** 2 - line.noise) for line, h in above if line.run == i]
        loud += sum(mine) > (STANDS_OUT * floors[i, channel]) ** 2
    return loud


def has_fast_rows(run: Recording) -> bool:
    """Whether a run turns fast, and its file has rows often enough to tell more than is compared."""
    measured = run.has >= MEASURED - {"tau_m"} and not run.locked
    return measured and run.turning > EXCITED and run.rate > OFTEN * RATE


def _sigma(run: Recording) -> float:
    return run.smoother.sigma_hz


def _shows(run: Recording) -> bool:
    """Whether a run with fast rows turns steadily."""
    if not has_fast_rows(run):
        return False
    speed = np.concatenate([run.smoother.same(piece.theta_m, 1) for piece in run.pieces])
    low, high = np.percentile(speed, (5, 95))
    return float(high - low) < STEADY * run.turning


def _lines(s: Solution, i: int, channel: str) -> list[Line]:
    """The orders in a channel of one run, up to what its rows can tell."""
    run = s.design.eq.runs[i]
    longest = max(run.pieces, key=lambda piece: piece.t.size)
    rows = np.arange(min(longest.t.size, round(LONG / run.smoother.dt)))
    piece, smoother = longest.part(rows), Smoother(WIDER * _sigma(run), run.smoother.dt, 1)
    e = _left(s, replace(run, pieces=(piece,), smoother=smoother), channel)
    theta = piece.theta_m[smoother.centres(piece.t.size)]
    rate = run.turning / TURN  # turns a second
    window = np.hanning(e.size)
    window /= window.sum()

    def height(order: float) -> complex:
        return complex((window * e) @ np.exp(-1j * order * theta))

    top = min(ORDERS, int(TO / (run.smoother.dt * rate)))
    return [
        Line(i, n, height(n), n * rate, float(np.mean([abs(height(n + by)) ** 2 for by in BESIDE])))
        for n in range(1, top + 1)
    ]


def _left(s: Solution, wide: Recording, channel: str) -> Array:
    """What the model leaves of a channel in all rows of a run, about its mean, rad or N·m (n,)."""
    y, z, at = unmasked(wide, channel)
    e = y - z @ s.x[list(at)]
    for i, term in enumerate(s.design.terms):
        made = unmasked_columns(wide, term, {channel})
        if channel in made:
            e = e - np.nan_to_num(made[channel]) @ s.x[s.design.place(i)]
    return np.asarray(e - e.mean())


def _from_speed_to_speed(lines: list[Line], power: int) -> npt.NDArray[np.complex128]:
    """Heights (n,) without what an order has at every speed, with a power of it."""
    order = np.array([line.order for line in lines], dtype=int)
    height = np.array([line.height for line in lines])
    shape = np.array([line.hz for line in lines]) ** power
    weight = shape / np.maximum(np.array([line.noise for line in lines]), 1e-300)
    for n in np.unique(order):
        mine = order == n
        height[mine] -= shape[mine] * (weight[mine] @ height[mine]) / (weight[mine] @ shape[mine])
    return height
