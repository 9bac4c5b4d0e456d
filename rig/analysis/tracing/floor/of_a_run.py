"""The floor of one run, compared with a repeat or not, and by how much more than it a single run may leave."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.optimize import nnls
from scipy.special import fdtri

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.noise import Measured, of_sensors
from rig.analysis.tracing.floor.offsets import ENOUGH
from rig.analysis.tracing.runs.alike import alike, as_fast
from rig.analysis.tracing.thresholds import CHANCE, GAIN, LENIENT, MISSING
from rig.model.effect import Array

PAIRS = 3  # of repeats, from which on they say something of other conditions
STAYS = 0.1  # of the rows of a locked run: fewer are left where it was read stay by stay


def floor_of(measured: Measured, eq: Equations, key: Key) -> float:
    """RMS expected of one run: its repeats' where they were compared, else of the same procedure, else of all; where a
    motor sticks and jumps, its encoder's rounding at least, which repeats share. And no less than all of its kind come
    to: one pair tells little.
    """
    alone = float(np.hypot(_compared(measured, eq, key), gain_of(measured, eq, key) * _swing(eq, key[0])))
    return max(alone, _least(measured, eq, key))


def _of_its_kind(measured: Measured, eq: Equations, key: Key) -> float:
    """Of all pairs; of those that turn freely alone where it does and enough were compared: under the torques of a lock
    test a gain that is never twice the same makes many times what it does elsewhere. In A, whose noise is the sensors',
    of those of its procedure alone where they are enough: how much of it is left goes by the speed."""
    run, channel = key
    usual = [i for i, c in measured.by_run if c == channel and (i, c) not in measured.apart]
    turning = [i for i in usual if not eq.runs[i].locked and (i, channel) in eq.rows]
    every = measured.noise.sigma[channel]
    if eq.runs[run].locked or len(turning) < 2 * ENOUGH:
        return min(every, _with_its_sensors(measured, eq, key, every, usual))
    same = [i for i in turning if eq.runs[i].procedure == eq.runs[run].procedure]
    among = same if channel == "A" and len(same) >= 2 * ENOUGH else turning
    rows = [eq.rows[i, channel].y.size for i in among]
    pooled = float(np.sqrt(np.average([measured.by_run[i, channel] ** 2 for i in among], weights=rows)))
    return min(every, pooled, _with_its_sensors(measured, eq, key, pooled, among))


def _with_its_sensors(measured: Measured, eq: Equations, key: Key, pooled: float, among: Sequence[int]) -> float:
    """The floor `pooled` of the runs `among` with what sensor noise leaves of this one in the place of what it leaves
    of theirs, where both are known: a run read four times as often has half of it."""
    rows = [eq.rows[i, key[1]].y.size for i in among if (i, key[1]) in eq.rows]
    theirs = [of_sensors(eq, measured.white, i, key[1]) for i in among if (i, key[1]) in eq.rows]
    mine = of_sensors(eq, measured.white, *key)
    if not rows or not mine or not all(theirs):
        return pooled
    return float(np.sqrt(max(pooled**2 + mine**2 - float(np.average(np.square(theirs), weights=rows)), mine**2)))


def leniency(measured: Measured, eq: Equations, key: Key) -> float:
    """By how much more a single run may exceed its floor than where the floor is that of many independent rows: its
    square over the floor's is F-distributed. Where a pair or two stand for all conditions, of one that is not theirs
    nothing is known: how an encoder's rounding beats with the rows goes by the speed.
    """
    run, channel = key
    known = {i: nu for (i, c), nu in measured.freedom.items() if c == channel}
    # of reversals the floor is that of the motor torque
    told = [i for i, c in measured.freedom if c == ("M" if channel == "R" else channel)]
    if told and len(told) < 2 * PAIRS and not any(alike(eq.runs[run], eq.runs[i]) for i in told):
        return LENIENT
    like = [nu for i, nu in known.items() if eq.runs[i].procedure == eq.runs[run].procedure]
    if not like:
        return 1.0
    nu = float(1 / np.mean(1 / np.array(like)))
    limit = float(np.sqrt(fdtri(nu, nu * max(1, len(like) // 2), CHANCE)))
    return float(np.clip(limit / MISSING, 1.0, LENIENT))


def floor_beside_gain(measured: Measured, eq: Equations, key: Key) -> float:
    """`floor_of` without what a torque sensor's gain may do."""
    return max(_compared(measured, eq, key), _least(measured, eq, key))


def _least(measured: Measured, eq: Equations, key: Key) -> float:
    return float(np.hypot(_of_its_kind(measured, eq, key), _rounding(eq, key)))


def gain_of(measured: Measured, eq: Equations, key: Key) -> float:
    """What a torque sensor's gain, never twice quite the same, does to A, rad per N·m, where the torque swings further
    than in all runs of its kind that were compared."""
    run, channel = key
    if channel != "A" or key in measured.by_run or "tau_l" not in eq.runs[run].has:
        return 0.0
    like = [i for i, c in measured.by_run if c == channel and as_fast(eq.runs[i], eq.runs[run])]
    shown = max((_swing(eq, i) for i in like), default=0.0)
    unseen = float(np.sqrt(max(1.0 - (shown / max(_swing(eq, run), 1e-9)) ** 2, 0.0)))
    return GAIN * unseen / eq.runs[run].pieces[0].gear.K


def _swing(eq: Equations, run: int) -> float:
    """RMS of the torque about its mean, N·m."""
    return float(np.nanstd(np.concatenate([p.torque for p in eq.runs[run].pieces])))


def _rounding(eq: Equations, key: Key) -> float:
    """RMS of the motor encoder's rounding at the output [rad] in A of a run read stay by stay; 0 in any other."""
    run, r = eq.runs[key[0]], eq.rows[key]
    read_by_stay = run.locked and run.counts_m > 0 and r.y.size < STAYS * r.keep.size
    return 2 * np.pi / (run.counts_m * run.ratio * np.sqrt(12)) if key[1] == "A" and read_by_stay else 0.0


def _compared(measured: Measured, eq: Equations, key: Key) -> float:
    if key in measured.by_run:
        return measured.by_run[key]
    run, channel = key
    known = {i: v for (i, c), v in measured.by_run.items() if c == channel}
    like = [v for i, v in known.items() if as_fast(eq.runs[i], eq.runs[run])]
    usual = {i: v for i, v in known.items() if (i, channel) not in measured.apart}
    same = {i: v for i, v in usual.items() if eq.runs[i].procedure == eq.runs[run].procedure}
    if like:
        return float(np.sqrt(np.mean(np.square(like))))
    if same:
        return _at_other_conditions(same, eq, run)
    # most of the others go one way, and have no friction in what they differ by
    friction = measured.friction.of(eq.runs[run]) if channel == "M" else 0.0
    return float(np.sqrt(_elsewhere(measured, eq, key) ** 2 + friction))


def _at_other_conditions(same: Mapping[int, float], eq: Equations, run: int) -> float:
    """From runs of the same kind at other speeds and loads: σ² = a + b·ω² + c·T², b of a clock that jitters and c of a
    torque sensor's gain that wanders, each only where three speeds, three loads show it; else their mean."""
    power, at = np.square(list(same.values())), np.array([_conditions(eq, i) for i in same])
    shown = [j for j in (0, 1) if _differ(at[:, j]) >= ENOUGH]
    if not shown:
        return float(np.sqrt(np.mean(power)))
    z = np.hstack([np.ones((power.size, 1)), at[:, shown]])
    found, _ = nnls(z / z.max(0), power)
    return float(np.sqrt(np.array([1.0, *np.array(_conditions(eq, run))[shown]]) / z.max(0) @ found))


def _conditions(eq: Equations, run: int) -> tuple[float, float]:
    """Mean |ω_m| and mean torque of a run, both squared."""
    return eq.runs[run].turning ** 2, eq.runs[run].mean_torque ** 2


def _differ(square: Array) -> int:
    """How many conditions that are a tenth apart and more there are."""
    return int(np.unique(np.round(np.log(np.maximum(square, 1e-9)), 1)).size)


def _elsewhere(measured: Measured, eq: Equations, key: Key) -> float:
    """From runs of other procedures, with this one's share of sensor noise in the place of theirs: a file of a quarter
    of the rate averages it less.
    """
    run, channel = key
    own = [v for (i, c), v in measured.white.items() if c == channel and eq.runs[i].procedure == eq.runs[run].procedure]
    compared = {eq.runs[i].procedure for i, c in measured.by_run if c == channel}
    theirs = [v for (i, c), v in measured.white.items() if c == channel and eq.runs[i].procedure in compared]
    usual = measured.noise.sigma[channel]
    if not own or not theirs:
        return usual
    mine = float(np.mean(np.square(own)))
    return float(np.sqrt(max(usual**2 + mine - float(np.mean(np.square(theirs))), mine)))
