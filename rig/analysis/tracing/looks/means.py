"""At means of the motor torque: where friction goes with the time or the speed, none has a mean of its own.

How far a run's mean lies from the others' is read from repeats, and is the run's own. Of a drive that warms while all
conditions are gone through once, and then once more, that is the warming itself, and little of it is within a run. Of
one that is cold again the next day repeats tell nothing, and all runs together do. And a friction that falls with the
speed is the same all through a run that keeps its speed: only between runs it shows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.floor.offsets import offset
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.residual.drifting_zeros import constants, falling, foretold
from rig.analysis.tracing.residual.levels import between, levels
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.runs.campaign import Campaign, looking
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.selection.selected import Selected
from rig.model.effect import Array
from rig.model.effects.quadratic_drag import QuadraticDrag
from rig.model.effects.stribeck_friction import StribeckFriction
from rig.model.effects.thermal_friction_drift import ThermalFrictionDrift

WARMING: Final = ThermalFrictionDrift.name
BY_SPEED: Final = frozenset({StribeckFriction.name, QuadraticDrag.name})
TOLD: Final = BY_SPEED | {WARMING}  # what the look is for
FEWEST: Final = 4  # pairs of repeats
MANY: Final = 10  # runs that go one way: three numbers are their speed's, two the use's
LEFT: Final = 0.5  # of what runs' friction differs by beside their speed: of one time constant a fifth is left
WIDE: Final = 2.0  # times the noise, how far repeats lie apart
ELSEWHERE: Final = 2.0  # floors left in the angles or the shaft's torque: no friction of the motor explains that


def wanted(selected: Selected) -> bool:
    """Whether the later of two repeats has less friction throughout, by far more than noise, or all runs have the less
    the longer the drive has been in use, or another one at every speed, and nothing says why; and all of what is left
    may be that, for the look counts where it explains everything."""
    return _asked_for(selected) and _left_elsewhere(selected) < ELSEWHERE


def _left_elsewhere(selected: Selected) -> float:
    at = selected.p.held_out
    left = at.residuals(selected.solution, selected.held)
    return max((at.ratio(left, keys) for c in "AL" if (keys := [key for key in left if key[1] == c])), default=0.0)


def _asked_for(selected: Selected) -> bool:
    warms = WARMING not in selected.names and (_less_each_time(selected) or _less_with_use(selected))
    return warms or (BY_SPEED.isdisjoint(selected.names) and _by_speed(selected))


def _less_each_time(selected: Selected) -> bool:
    s = selected.solution
    noise = s.design.eq.noise
    if not noise.local["M"] > WIDE * noise.sigma["M"]:
        return False
    runs = s.design.eq.runs
    pairs = [sorted(pair, key=lambda i: runs[i].start) for pair in repeats(runs, selected.p.split.fitted)]
    gone = [_friction(selected, b) - _friction(selected, a) for a, b in pairs if _turns_one_way(selected, a, b)]
    return len(gone) >= FEWEST and max(gone) < 0


def _less_with_use(selected: Selected) -> bool:
    """Of runs that go one way, beside what their speed makes; repeats on another day are as long after its start, and
    tell nothing of it."""
    eq = selected.solution.design.eq
    runs, friction, speed = _one_way(selected)
    if len(runs) < MANY:
        return False
    by_speed = np.stack([np.ones(speed.size), speed, speed**2], 1)
    _, _, before = foretold(by_speed, by_speed, friction)
    colder = _colder_in_use([eq.runs[i] for i in runs]) + _colder_by_heat([eq.runs[i] for i in runs])
    tried = [np.hstack([by_speed, cold[:, None]]) for cold in colder]
    _, fit, after = min((foretold(z, z, friction) for z in tried), key=lambda found: found[2])
    return bool(fit[-1] > 0 and after < LEFT * before)


def _by_speed(selected: Selected) -> bool:
    """Of runs that go one way, beyond what those at one speed differ by, and by as much as noise."""
    _, friction, speed = _one_way(selected)
    noise = selected.solution.design.eq.noise.sigma["M"]
    return between(friction / noise, levels(speed)) is not None if speed.size else False


def _one_way(selected: Selected) -> tuple[list[int], Array, Array]:
    """The k runs that go one way, their friction beyond the baseline's [N·m] (k,), and their speed [rad/s] (k,)."""
    runs = [i for i in range(len(selected.solution.design.eq.runs)) if _turns_one_way(selected, i, i)]
    friction = np.array([_friction(selected, i) for i in runs])
    return runs, friction, np.array([selected.solution.design.eq.runs[i].turning for i in runs])


def _colder_in_use(runs: Sequence[Recording]) -> list[Array]:
    """How cold the drive is in each of `runs`, (n,), as it warms by the clock, with several time constants."""
    used = np.array([np.mean([np.mean(piece.in_use) for piece in run.pieces]) for run in runs])
    return [falling(used, tau)[:, 1] for tau in constants(max(float(np.ptp(used)), 1.0))]


def _colder_by_heat(runs: Sequence[Recording]) -> list[Array]:
    """The same as it warms by its own friction."""
    leaks = ThermalFrictionDrift.LEAKS
    return [-np.array([np.mean([np.mean(p.heat(t_w)) for p in run.pieces]) for run in runs]) for t_w in leaks]


def _turns_one_way(selected: Selected, a: int, b: int) -> bool:
    eq = selected.solution.design.eq
    return all((i, "M") in eq.rows and not eq.runs[i].locked and abs(_way(eq.runs[i].pieces)) == 1.0 for i in (a, b))


def _way(pieces: Sequence[object]) -> float:
    return float(np.mean(np.concatenate([piece.way for piece in pieces])))  # type: ignore[attr-defined]


def _friction(selected: Selected, run: int) -> float:
    """What the baseline leaves in the mean of a run's motor torque, against its motion, N·m."""
    return offset(selected.solution, run, "M") * _way(selected.solution.design.eq.runs[run].pieces)


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """The same where no run's motor torque has a mean of its own. It counts where it names what friction goes with,
    beside all that had a name and nothing else, and explains everything: more than a law without a name did that it is
    without."""
    looks = [replace(run.look, steady=True) for run in so_far.p.campaign.runs]
    p = prepare(looking(campaign, looks), hold_out)
    other, ranked = searched(p, TOLD, lambda one: not TOLD.isdisjoint(one.names) or one.left < so_far.left)
    new = other.names - so_far.names
    told = not other.loud and other.names > so_far.names - CONFOUNDERS.keys() and new <= TOLD
    if not so_far.names <= other.names:
        told = told and other.left < so_far.left
    return (other, ranked) if told else (so_far, found)
