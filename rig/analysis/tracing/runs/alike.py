"""Which runs repeat one another: the same words, the same motion, the same torque."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rig.analysis.tracing.runs.recording import Recording, mean_way
from rig.model.effect import Array

CLOSE = 0.05  # relative: travel and speed of repeats agree so well
SLIPS = 0.2  # the same of the speed of a locked run: a motor that sticks and slips goes back and forth now and then
STOPS = 0.15  # the same of how far it was wound up: a motor that sticks stops short, by friction once more or less
SAME_ANGLE = 0.1  # rad, of a motor that is locked: a spring is another one at another angle
READINGS = 100  # of the angle of a locked run: a few for every stroke
SAME_LOAD = 1.0  # N·m, how far the means of repeats lie apart: zeros of a sensor, friction that scatters
ONE_WAY = 0.9  # of the rows, less those the other way
SOON = 3.0  # times the usual gap between repeats, and its own length: later ones may have drifted


def repeats(runs: Sequence[Recording], among: Sequence[int]) -> list[tuple[int, int]]:
    """Pairs of runs of the same condition, each run once, nearest in time first."""
    pairs = sorted(
        (abs(runs[j].start - runs[i].start), i, j) for i in among for j in among if i < j and alike(runs[i], runs[j])
    )
    used: set[int] = set()
    out: list[tuple[float, int, int]] = []
    for gap, i, j in pairs:
        if i not in used and j not in used:
            used |= {i, j}
            out.append((gap, i, j))
    usual = float(np.median([gap for gap, _, _ in out])) if out else 0.0
    return [(i, j) for gap, i, j in out if gap - min(runs[i].duration, runs[j].duration) <= SOON * usual]


def alike(a: Recording, b: Recording) -> bool:
    """Same words, and the same motion, the same way round and under the same torque: words may leave both out."""
    if "tau_l" in a.has & b.has and not np.isclose(a.mean_torque, b.mean_torque, rtol=CLOSE, atol=SAME_LOAD):
        return False
    return moved_alike(a, b)


def moved_alike(a: Recording, b: Recording) -> bool:
    """The same, whatever the torque reads."""
    return _heading(a) * _heading(b) >= 0 and as_fast(a, b)


def as_fast(a: Recording, b: Recording) -> bool:
    """The same, whichever way round."""
    if a.said != b.said or a.has != b.has or a.locked != b.locked:
        return False
    if a.input_locked is not b.input_locked or (a.input_locked and abs(_held_at(a) - _held_at(b)) > SAME_ANGLE):
        return False
    close = (STOPS, SLIPS) if a.locked else (CLOSE, CLOSE)
    ways = zip(travel(a), travel(b), close, strict=True)
    return all(abs(u - v) <= least * max(abs(u), abs(v), 1e-9) for u, v, least in ways)


def travel(run: Recording) -> tuple[float, float]:
    """Range of the motor angle over the time it took, and mean |speed|; rad/s. Length of a run does not matter. Of a
    locked run the range, and the mean speed read now and then: what the motor trembles on its counts is no way gone."""
    angles = [run.wound(p) for p in run.pieces]
    low, high = min(float(x.min()) for x in angles), max(float(x.max()) for x in angles)
    if run.locked:
        return high - low, sum(_gone(x) for x in angles) / sum(p.t.size * p.dt for p in run.pieces)
    speed = float(np.mean([np.mean(np.abs(p.omega_m)) for p in run.pieces]))
    turning = abs(float(np.mean([np.mean(p.omega_m) for p in run.pieces]))) > 0.5 * speed
    return speed, speed if turning else high - low


def _held_at(run: Recording) -> float:
    """rad, of a motor that is locked."""
    return float(run.pieces[0].theta_m.mean())


def _heading(run: Recording) -> int:
    """1 or −1 of a run that turns one way, else 0: conditions may give a speed without its sign."""
    if run.locked:
        return 0
    way = mean_way(run)
    return 0 if abs(way) < ONE_WAY else int(np.sign(way))


def _gone(theta: Array) -> float:
    """Way of an angle (n,) between READINGS of it, rad."""
    return float(np.abs(np.diff(theta[:: max(1, theta.size // READINGS)])).sum())
