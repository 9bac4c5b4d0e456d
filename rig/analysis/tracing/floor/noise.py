"""Noise of each channel, from repeats where there are some, else from neighbouring turns and strokes of one run."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls
from scipy.special import fdtri

from rig.analysis.tracing.fit.channels import CHANNELS, WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key, Noise
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.repeats import (
    Scatter,
    autocorrelation,
    beside_a_row,
    compare,
    effective,
    freedom,
    repeats,
    scatter,
    strokes,
)
from rig.analysis.tracing.thresholds import CHANCE, FLOOR_LEAST, GAIN, LENIENT, MISSING, TURNED_BACK, ZERO
from rig.core.units import TURN
from rig.model.effect import Array

ENOUGH = 3  # pairs of repeats: of fewer, a spread is not known to a factor of two
LEAST_OFFSET = 0.25  # of the floor, RMS: a dozen pairs do not show less, and no mean is worth more rows than that
FEW = 25  # rows to compare: fewer have no spread worth the name
STAYS = 0.1  # of the rows of a locked run: fewer are left where it was read stay by stay


@dataclass(frozen=True)
class Measured:
    """The noise to weight with, and what it was measured on: RMS by run (a repeated one) and channel. `white` is the
    part that sensors make, in the few runs it is known of."""

    noise: Noise
    by_run: dict[Key, float]
    white: dict[Key, float]
    how: dict[str, str]
    freedom: dict[Key, float]  # degrees of freedom of the RMS of a pair of repeats


def guess(eq: Equations) -> Noise:
    """Before anything is fitted: what is rough in the responses."""
    sigma: dict[str, float] = {}
    for channel in WHOLE:
        rough = [np.diff(r.y, 4) for (_, c), r in eq.rows.items() if c == channel]
        spread = float(np.median(np.abs(np.concatenate(rough)))) if rough else 1.0
        sigma[channel] = max(spread / 0.6745 / np.sqrt(70) * 2, 1e-12)  # twice: the low-pass took half of it
    return _at_reversals(Noise(sigma, dict.fromkeys(CHANNELS, 4.0), dict.fromkeys(CHANNELS, np.inf)))


def measure(solution: Solution, among: Sequence[int]) -> Measured:
    """Floor of every channel from the runs `among`, from the residuals of a model that repeats share."""
    eq, e = solution.design.eq, {key: solution.residual(key) for key in solution.keys}
    pairs = repeats(eq.runs, among)
    sigma, kappa, local = dict(eq.noise.sigma), dict(eq.noise.kappa), dict(eq.noise.local)
    by_run: dict[Key, float] = {}
    free: dict[Key, float] = {}
    how: dict[str, str] = {}
    for channel in WHOLE:
        found = [s for pair in pairs if (s := scatter(eq, e, pair, channel)) is not None]
        words = f"{len(found)} pair{'s' if len(found) > 1 else ''} of repeats compared at equal motor angle"
        if not found:
            found = [s for i in among if (s := neighbours(eq, e, (i, channel))) is not None]
            words = (
                f"neighbouring turns or strokes of {len(found)} runs compared at equal motor angle, no repeats there"
            )
        if not found:
            continue
        how[channel] = words
        n = np.array([s.rows for s in found])
        sigma[channel] = float(np.sqrt(np.average([s.rms**2 for s in found], weights=n)))
        kappa[channel] = effective(np.average([s.rho / s.rho[0] for s in found], axis=0, weights=n))
        by_run |= {(i, channel): s.rms for s in [*_alone(eq, e, channel, among, found), *found] for i in s.pair}
        free |= {(i, channel): s.freedom for s in found for i in s.pair}
        by_run |= _never_compared(eq, e, channel, among, found)
        local[channel] = own_offset(solution, channel, found, sigma[channel] ** 2 * kappa[channel])
    local["A"] = own_angle(solution, pairs, sigma["A"] * LEAST_OFFSET)
    design = solution.design
    white = {key: float(np.sqrt(np.mean(design.noise_left(key, solution.x) ** 2))) for key in design.noise}
    turned = max((rms for (_, c), rms in white.items() if c == "R"), default=0.0)
    return Measured(_at_reversals(Noise(sigma, kappa, local), turned), by_run, white, how, free)


def _at_reversals(noise: Noise, white: float = 0.0) -> Noise:
    """With R as noisy as M, and a little more: it has too few rows to compare repeats in. And as noisy as the sensors
    make it, RMS `white`: of a coarse encoder the acceleration is used there alone."""
    sigma = noise.sigma | {"R": float(np.hypot(TURNED_BACK * noise.sigma["M"], white))}
    return Noise(sigma, noise.kappa | {"R": noise.kappa["M"]}, noise.local | {"R": noise.local["M"]})


def quieter(one: Measured, other: Measured) -> Measured:
    """Of each channel the floor that is lower, and the offset of a run's own that is smaller: beside effects that are
    there repeats differ less, not more."""
    best = {c: min((one, other), key=lambda m: m.noise.sigma[c]) for c in CHANNELS}
    noise = Noise(
        {c: m.noise.sigma[c] for c, m in best.items()},
        {c: m.noise.kappa[c] for c, m in best.items()},
        {c: min(one.noise.local[c], other.noise.local[c]) for c in CHANNELS},
    )
    by_run = {key: rms for c, m in best.items() for key, rms in m.by_run.items() if key[1] == c}
    white = {key: rms for c, m in best.items() for key, rms in m.white.items() if key[1] == c}
    how = {c: m.how[c] for c, m in best.items() if c in m.how}
    free = {key: nu for c, m in best.items() for key, nu in m.freedom.items() if key[1] == c}
    return Measured(noise, by_run, white, how, free)


def _alone(
    eq: Equations, e: Mapping[Key, Array], channel: str, among: Sequence[int], found: Sequence[Scatter]
) -> list[Scatter]:
    """In A, whose noise is white, runs of conditions that no pair was compared in, each beside itself: how an encoder's
    rounding averages out depends on the speed.
    """
    if channel != "A":
        return []
    said = {eq.runs[i].said for s in found for i in s.pair}
    rest = [i for i in among if eq.runs[i].said not in said and (i, channel) in e]
    return [s for i in rest if (s := neighbours(eq, e, (i, channel))) is not None]


def _never_compared(
    eq: Equations, e: Mapping[Key, Array], channel: str, among: Sequence[int], found: Sequence[Scatter]
) -> dict[Key, float]:
    """In M, locked runs of which no two were compared: all that is left of them counts as noise.

    A motor that creeps against a spring sticks and slips: its friction is no other run's, and judges nothing.
    """
    compared = {eq.runs[i].procedure for s in found for i in s.pair}
    rest = [i for i in among if eq.runs[i].locked and eq.runs[i].procedure not in compared]
    return {(i, "M"): float(np.sqrt(np.mean(e[i, "M"] ** 2))) for i in rest if channel == "M" and (i, "M") in e}


def own_offset(s: Solution, channel: str, found: Sequence[Scatter], variance: float) -> float:
    """How far a run's offset lies from the others', beyond what noise does to a mean."""
    ratio = s.design.eq.runs[found[0].pair[0]].ratio
    least = {"A": np.inf, "M": ZERO / ratio, "L": ZERO}[channel]
    if not np.isfinite(least) or len(found) < ENOUGH or found[0].pair[0] == found[0].pair[1]:
        return least
    gaps = [offset(s, a, channel) - offset(s, b, channel) for a, b in (pair.pair for pair in found)]
    excess = float(np.mean([gap**2 / 2 - variance / pair.rows for gap, pair in zip(gaps, found, strict=True)]))
    return float(np.sqrt(max(excess, (0.2 * least) ** 2)))


def own_angle(s: Solution, pairs: Sequence[tuple[int, int]], least: float) -> float:
    """How far c_0 of a run lies from the others' [rad], read from repeats; infinite where fewer than three show it.

    Where both encoders are homed once and for all, runs at any speed and load share it, and what shifts it from one
    speed to another is an effect.
    """
    gaps = [offset(s, a, "A") - offset(s, b, "A") for a, b in pairs if (a, "A") in s.keys and (b, "A") in s.keys]
    if len(gaps) < ENOUGH:
        return np.inf
    return max(float(np.sqrt(np.mean(np.square(gaps)) / 2)), least)


def offset(s: Solution, run: int, channel: str) -> float:
    """What the baseline leaves in a channel of one run, in its unit, before any step of its own; repeats share what
    effects add. From all rows, not from a residual: that has lost as much of it as the offset is believed to wander."""
    eq, key = s.design.eq, (run, channel)
    r, own = eq.rows[key], eq.own.get(key, np.zeros((eq.rows[key].y.size, 0)))
    z = np.hstack([np.ones((r.y.size, 1)), own])
    return float(np.linalg.lstsq(z, r.y - r.z @ s.x[list(r.at)], rcond=None)[0][0])


def neighbours(eq: Equations, e: Mapping[Key, Array], key: Key) -> Scatter | None:
    """One turn against the next, or one stroke against the next of its direction, of a single run."""
    if key not in e:
        return None
    theta = eq.rows[key].theta_m
    parts = strokes(theta)
    if len(parts) >= 3:
        made = [compare(theta[a], e[key][a], theta[b], e[key][b]) for a, b in zip(parts, parts[2:], strict=False)]
    else:
        made = [against_both(theta[p], e[key][p]) for p in parts]
    d = np.concatenate([m - m.mean() for m in made if m.size]) if any(m.size for m in made) else np.zeros(0)
    if d.size < FLOOR_LEAST / 4:
        return None
    return Scatter((key[0], key[0]), float(np.sqrt(np.mean(d**2))), d.size, 0.0, autocorrelation(d), freedom(d))


def against_both(theta: Array, e: Array) -> Array:
    """Differences of every row of one stroke to the mean of a motor turn before and one after, as if of one run; (n,).

    What the output or the load does within a motor turn is nearly straight, and goes out.
    """
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


def floor_of(measured: Measured, eq: Equations, key: Key) -> float:
    """RMS expected of one run: its repeats' where they were compared, else of the same procedure, else of all; where a
    motor sticks and jumps, its encoder's rounding at least, which repeats share. And no less than all of its kind come
    to: one pair tells little.
    """
    alone = float(np.hypot(_compared(measured, eq, key), _gain(measured, eq, key)))
    return max(alone, float(np.hypot(_of_its_kind(measured, eq, key), _rounding(eq, key))))


def _of_its_kind(measured: Measured, eq: Equations, key: Key) -> float:
    """Of all pairs; of those that turn freely alone where it does and enough were compared: under the torques of a lock
    test a gain that is never twice the same makes many times what it does elsewhere."""
    run, channel = key
    free = [i for i, c in measured.by_run if c == channel and not eq.runs[i].locked and (i, c) in eq.rows]
    if eq.runs[run].locked or len(free) < 2 * ENOUGH:
        return measured.noise.sigma[channel]
    rows = [eq.rows[i, channel].y.size for i in free]
    pooled = float(np.sqrt(np.average([measured.by_run[i, channel] ** 2 for i in free], weights=rows)))
    return min(pooled, measured.noise.sigma[channel])


def leniency(measured: Measured, eq: Equations, key: Key) -> float:
    """By how much more a single run may exceed its floor than where the floor is that of many independent rows: its
    square over the floor's is F-distributed.
    """
    run, channel = key
    known = {i: nu for (i, c), nu in measured.freedom.items() if c == channel}
    like = [nu for i, nu in known.items() if eq.runs[i].procedure == eq.runs[run].procedure]
    if not like:
        return 1.0
    nu = float(1 / np.mean(1 / np.array(like)))
    limit = float(np.sqrt(fdtri(nu, nu * max(1, len(like) // 2), CHANCE)))
    return float(np.clip(limit / MISSING, 1.0, LENIENT))


def _gain(measured: Measured, eq: Equations, key: Key) -> float:
    """What a torque sensor's gain, never twice quite the same, does to A [rad] where the torque swings further than in
    all runs of its kind that were compared."""
    run, channel = key
    if channel != "A" or key in measured.by_run or "tau_l" not in eq.runs[run].has:
        return 0.0
    like = [i for i, c in measured.by_run if c == channel and eq.runs[i].said == eq.runs[run].said]
    shown = max((_swing(eq, i) for i in like), default=0.0)
    return GAIN * float(np.sqrt(max(_swing(eq, run) ** 2 - shown**2, 0.0))) / eq.runs[run].pieces[0].gear.K


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
    said = [v for i, v in known.items() if eq.runs[i].said == eq.runs[run].said]
    same = {i: v for i, v in known.items() if eq.runs[i].procedure == eq.runs[run].procedure}
    if said:
        return float(np.sqrt(np.mean(np.square(said))))
    return _at_other_conditions(same, eq, run) if same else _elsewhere(measured, eq, key)


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
    torque = np.concatenate([p.torque for p in eq.runs[run].pieces])
    mean = float(np.nanmean(torque)) if np.isfinite(torque).any() else 0.0
    return eq.runs[run].turning ** 2, mean**2


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


def pairs_of(measured: Measured) -> int:
    """Runs the floor rests on."""
    return len({i for i, _ in itertools.chain(measured.by_run)})
