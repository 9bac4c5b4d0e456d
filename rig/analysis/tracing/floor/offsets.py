"""How far the offset of a run lies from those of others, read from repeats."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.repeats import Scatter
from rig.analysis.tracing.thresholds import ZERO
from rig.model.effect import Array

LEAST = 0.2  # of what a zero is believed to wander by: no wander that repeats show is smaller
SHOWN = 0.5  # of it: all of a torque's, none of an angle's
ENOUGH = 3  # pairs of repeats: of fewer, a spread is not known to a factor of two


def own_offset(s: Solution, channel: str, found: Sequence[Scatter], variance: float) -> float:
    """How far a run's offset lies from the others', beyond what noise does to a mean."""
    ratio = s.design.eq.runs[found[0].pair[0]].ratio
    least = {"A": np.inf, "M": ZERO / ratio, "L": ZERO}[channel]
    if s.design.eq.runs[0].look.steady and channel == "M":
        return LEAST * least
    if not np.isfinite(least) or len(found) < ENOUGH or found[0].pair[0] == found[0].pair[1]:
        return least
    gaps = [offset(s, a, channel) - offset(s, b, channel) for a, b in (pair.pair for pair in found)]
    excess = float(np.mean([gap**2 / 2 - variance / pair.rows for gap, pair in zip(gaps, found, strict=True)]))
    return float(np.sqrt(max(excess, (LEAST * least) ** 2)))


def own_angle(s: Solution, pairs: Sequence[tuple[int, int]], least: float) -> float:
    """How far c_0 of a run lies from the others' [rad], read from repeats; infinite where fewer than three show it.

    Where both encoders are homed once and for all, runs at any speed and load share it, and what shifts it from one
    speed to another is an effect.
    """
    known = [(a, b) for a, b in pairs if (a, "A") in s.keys and (b, "A") in s.keys and _on_one_side(s, a, b)]
    gaps = [offset(s, a, "A") - offset(s, b, "A") for a, b in known]
    if len(gaps) < ENOUGH:
        return np.inf
    return max(float(np.sqrt(np.mean(np.square(gaps)) / 2)), least)


def offset(s: Solution, run: int, channel: str) -> float:
    """What the baseline leaves in a channel of one run, in its unit, before any step of its own; repeats share what
    effects add, and what stands in both of them is none of their difference. From all rows, not from a residual: that
    has lost as much of it as the offset is believed to wander."""
    eq, key = s.design.eq, (run, channel)
    r, own = eq.rows[key], eq.own.get(key, np.zeros((eq.rows[key].y.size, 0)))
    own = own[:, np.ptp(own, axis=0) > 0]
    z = np.hstack([np.ones((r.y.size, 1)), own])
    return float(np.linalg.lstsq(z, r.y - r.z @ s.x[list(r.at)], rcond=None)[0][0])


def zero(s: Solution, run: int, channel: str) -> float:
    """`offset` less what the effects of the model make of it."""
    return offset(s, run, channel) - of_effects(s, run, channel)


def of_effects(s: Solution, run: int, channel: str, but: Collection[str] = ()) -> float:
    """What the effects of a model, `but` those, shift the mean of a channel of one run by, in its unit: a wave by what
    it is on average over a part of a turn (exam 93, case 02; exam 94, case 18)."""
    terms = [i for i, term in enumerate(s.design.terms) if term.name not in but]
    columns = ((i, s.design.eq.term(run, s.design.terms[i]).get(channel)) for i in terms)
    return float(sum((z @ s.x[s.design.place(i)]).mean() for i, z in columns if z is not None))


def of_the_torque_sensor(s: Solution, runs: Sequence[int]) -> bool:
    """Whether it is the torque sensor's zero that makes those runs' zeros of θ̃ differ: the load's balance shows it as a
    torque that winds the gear up by as much, and of an angle's zero nothing. Friction differs there from run to run, so
    that how its own zeros differ is hard to see."""
    pair = _angle_and_torque(s, runs)
    return pair is not None and bool(-s.value("compliance") * (pair[0] @ pair[1]) > SHOWN * (pair[0] @ pair[0]))


def by_the_torque_sensor(s: Solution, runs: Sequence[int]) -> bool:
    """Whether it is the torque sensor's zero that makes those runs' zeros of the load's balance differ: the angle, too,
    is off by what they seem to wind the gear up by. True where that was not measured, for then nobody knows."""
    pair = _angle_and_torque(s, runs)
    return pair is None or bool(-(pair[0] @ pair[1]) > SHOWN * s.value("compliance") * (pair[1] @ pair[1]))


def _angle_and_torque(s: Solution, runs: Sequence[int]) -> tuple[Array, Array] | None:
    """By how much the zeros of θ̃ [rad] and of the load's balance [N·m] lie from those of all, of runs with both."""
    if any((run, channel) not in s.design.eq.rows for run in runs for channel in "AL"):
        return None
    angle, torque = (np.array([zero(s, run, channel) for run in runs]) for channel in "AL")
    return angle - angle.mean(), torque - torque.mean()


def _on_one_side(s: Solution, a: int, b: int) -> bool:
    """Whether both runs, or neither, have a zero of their own in A, of the same level: a step between them is in their
    difference."""
    columns = (s.design.eq.own.get((run, "A"), np.zeros((1, 0))) for run in (a, b))
    first, second = (x[0, np.ptp(x, axis=0) == 0].tolist() for x in columns)
    return bool(first == second)
