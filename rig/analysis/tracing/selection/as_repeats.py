"""Whether the size that single runs want of an effect differs by no more than it does between repeats of one run.

Friction that wanders by some thousandths from run to run gives every run another size of an effect of friction, far
beyond the noise of its rows. Repeats of one run show how much; what only looks like the effect wants another size in
every condition, the same in its repeats: a one-way analysis of variance, the conditions being its groups.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.special import fdtrc

from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.floor.held_out import HeldOut
from rig.analysis.tracing.runs.alike import alike
from rig.analysis.tracing.runs.holdout import whole_run
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.selection.done import Without, done
from rig.analysis.tracing.thresholds import BY_CHANCE, FAINT, FAIR, FREE, MOSTLY, OF_ONE_SIZE, PLAIN_AMONG_REPEATS


@dataclass
class Condition:
    """Runs of one condition in one channel: `wanted` beyond the size all have, in units of a row's noise, (runs,)."""

    run: Recording
    names: set[str] = field(default_factory=set)
    wanted: list[float] = field(default_factory=list)


@dataclass
class Shown:
    """One channel: what the effect does there over the floor, squared and summed, in all and in unseen runs; what is
    left along it in the unseen ones; and the conditions."""

    kappa: float
    own: float = 0.0
    unseen: float = 0.0
    left: float = 0.0
    conditions: list[Condition] = field(default_factory=list)


def as_repeats(seen: Without, unseen: Without, at: HeldOut) -> bool:
    """Whether an effect is plainly there beside what repeats differ by, wants sizes that differ between conditions by
    no more than repeats do, and one size in runs seen and unseen. False where too few runs were repeated to say, in the
    channels it does most of its work in."""
    shown = _shown(seen, unseen, at)
    total = sum(channel.own for channel in shown)
    if not total:
        return False
    fair = [channel for channel in shown if channel.own > FAIR * total]
    known = [channel for channel in fair if _free(channel.conditions) >= FREE]
    if sum(channel.own for channel in known) < MOSTLY * sum(channel.own for channel in fair):
        return False
    noise = [_between_repeats(channel) for channel in known]
    plain = sum(channel.own / n for channel, n in zip(known, noise, strict=True))
    return plain > PLAIN_AMONG_REPEATS and all(_is_one_size(c, n) for c, n in zip(known, noise, strict=True))


def _shown(seen: Without, unseen: Without, at: HeldOut) -> list[Shown]:
    kappa = unseen.design.eq.noise.kappa
    shown = {c: Shown(kappa[c]) for c in CHANNELS if c in kappa}
    for one, floors in ((unseen, at.floors), (seen, at.seen)):
        for (run, c), _, f, e in done(one, floors):
            if c == "M" and one.design.eq.runs[run].locked:  # a motor that creeps against a spring sticks and slips
                continue
            square, spoilt = (e.size / floors[run, c] ** 2 * x for x in one.spoilt((run, c)))
            own, along = float(f @ f) - square, float(f @ e) - spoilt
            if own <= FAINT**2 * e.size:
                continue
            channel = shown[c]
            channel.own += own
            channel.unseen += own if one is unseen else 0.0
            channel.left += along if one is unseen else 0.0
            _condition(channel.conditions, one.design.eq.runs[run]).wanted.append(along / np.sqrt(own))
    return list(shown.values())


def _condition(conditions: list[Condition], run: Recording) -> Condition:
    """The one a run belongs to. Two parts of a run are no repeats of each other."""
    name = whole_run(run.name)
    found = next((c for c in conditions if name not in c.names and alike(c.run, run)), None)
    if found is None:
        found = Condition(run)
        conditions.append(found)
    found.names.add(name)
    return found


def _between_repeats(channel: Shown) -> float:
    """Variance of what runs want, as their repeats tell it."""
    return max(channel.kappa, _within(channel.conditions) / _free(channel.conditions))


def _is_one_size(channel: Shown, noise: float) -> bool:
    """Whether chance makes conditions differ as much, and what unseen runs want beside what seen ones do."""
    groups, seen = len(channel.conditions), channel.own - channel.unseen
    if groups < 2 or not channel.unseen or not seen:
        return False
    between = sum(len(c.wanted) * float(np.mean(c.wanted)) ** 2 for c in channel.conditions) / (groups - 1)
    chance = float(fdtrc(groups - 1, _free(channel.conditions), between / noise))
    # what the seen ones want is the size itself, and no surer than they are
    spread = np.sqrt(noise * channel.unseen * channel.own / seen)
    return chance > BY_CHANCE and abs(channel.left) < OF_ONE_SIZE * spread


def _free(conditions: Sequence[Condition]) -> int:
    return sum(len(c.wanted) - 1 for c in conditions)


def _within(conditions: Iterable[Condition]) -> float:
    return sum(float(np.var(c.wanted)) * len(c.wanted) for c in conditions)
