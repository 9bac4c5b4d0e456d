"""Rivals of a named effect, and the run that would decide between them; the run that shows most of what has no name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.answer import NextRun
from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, extended, fit
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, Scored, possible
from rig.analysis.tracing.floor.held_out import unseen
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.runs.holdout import split
from rig.analysis.tracing.selection.expected import TWICE, Proposal, imagined, proposals, sigmas
from rig.analysis.tracing.thresholds import CLOSE, QUIET, STILL_RUN

SIGMAS: Final = 3.0  # standard deviations, at least
HALF: Final = 0.5  # of the evidence, in the bank's coarse shapes: with less no refit catches up


def deciding(p: Prepared, names: Sequence[str], found: Found) -> tuple[tuple[str, ...], NextRun | None]:
    """Effects that alone would have done as well as the first one named, and the cheapest run that tells them apart."""
    best = next((r for r in found.ranking if r.term.name == names[0]), None)
    if best is None or len(names) > 1:
        return (), None
    others = [r for r in found.ranking if r.term.name not in names and r.evidence > HALF * best.evidence]
    mine = _alone(p, best) if others else None
    close = [
        r for r in others if mine is not None and _as_good(other := _alone(p, r), mine) and _instead(p, other, mine)
    ]
    rivals = tuple(r.term.name for r in close)
    if not rivals:
        return (), None
    asked = _by_information(p, best, close)
    return rivals, asked or by_table({names[0], *rivals})


@dataclass(frozen=True)
class Alone:
    """One candidate alone beside the baseline, its shape fitted: the fit, what it explains of the fitted runs, and the
    RMS over floor it leaves in the worst channel and the worst single run of the held-out ones."""

    solution: Solution
    gain: float
    channel: float
    single: float


def _alone(p: Prepared, candidate: Scored) -> Alone | None:
    """Of its laws the one that explains most; None where none can be such an effect's."""
    made = [alone for term in (candidate.term, *candidate.laws) if (alone := _by_law(p, term)) is not None]
    return max(made, key=lambda alone: alone.gain, default=None)


def _by_law(p: Prepared, law: Term) -> Alone | None:
    runs = p.split.fitted
    covered = reach([p.eq.runs[i] for i in runs])
    s = refine(p.baseline.design, law, runs, covered)[1]
    term = s.design.terms[0]
    if term.effect.beyond(term.shape, covered) or not possible(s, term, s.x[s.design.place(0)]):
        return None
    worst = p.held_out.worst(p.held_out.residuals(s, unseen(s, p.held_out)))
    return Alone(s, s.gain - p.baseline.gain, *worst)


def _as_good(rival: Alone | None, best: Alone) -> bool:
    """Whether a rival explains nearly as much alone, and leaves no more of unseen runs than the best or the floor."""
    if rival is None or rival.gain < CLOSE * best.gain:
        return False
    return rival.channel < max(QUIET, best.channel) and rival.single < max(STILL_RUN, best.single)


def _instead(p: Prepared, rival: Alone | None, best: Alone) -> bool:
    """Whether a rival explains what the best does: beside one that explains as much of another channel, the best has
    all of its own left to explain."""
    if rival is None:
        return False
    both = fit(extended(rival.solution.design, best.solution.design.terms[0], p.split.fitted))
    return both.gain - rival.solution.gain < HALF * best.gain


def _by_information(p: Prepared, best: Scored, close: Sequence[Scored]) -> NextRun | None:
    """The cheapest run of the catalogue that is expected to make every rival's evidence fall behind; where none is, the
    one that tells most; None when none tells anything.

    A rival is one while it has CLOSE of the best one's evidence: what the run tells, in nats, has to be more than that.
    """
    eq = p.eq
    proposed = proposals(eq.runs[0].pieces[0].dt)
    need = max(SIGMAS, float(np.sqrt(2 * (1 - CLOSE) * best.evidence)))
    told = np.full(len(proposed), np.inf)
    for other in close:
        for f, g in ((best.term, other.term), (other.term, best.term)):
            told = np.minimum(told, sigmas(p.baseline, f, g, p.split.fitted, proposed))
    told = told * np.sqrt([_fitted(p, run) for run in proposed])
    most = int(np.argmax(told))
    able = [i for i in range(len(proposed)) if told[i] > need] or ([most] if told[most] > SIGMAS else [])
    if not able:
        return None
    cost = [run.cost(eq.runs[0].pieces[0].dt) for run in proposed]
    first = min(able, key=lambda i: (cost[i], -told[i]))
    names = " from ".join(sorted({best.term.name, *(r.term.name for r in close)}))
    rank = f"the cheapest of {len(able)} runs that would" if told[first] > need else "the most that any run would"
    because = (
        f"separates {names} by {told[first]:.0f} standard deviations expected ({need:.0f} are needed), {rank}: "
        f"{cost[first]:.0f} s of rig time with its repeat"
    )
    return NextRun(proposed[first].procedure, dict(proposed[first].conditions), because)


def _fitted(p: Prepared, proposal: Proposal) -> float:
    """Share of the run and its repeat that the next trace would fit: of most pairs one of the two is held out. A speed
    or load between others would be both, but what was made last is not."""
    runs = p.campaign.runs
    like = next(p.eq.runs[i] for i in p.split.fitted)
    made = imagined(proposal, like, p.baseline, max(float(run.pieces[-1].t[-1]) for run in runs))
    again = split((*runs, *(replace(made, name=f"{made.name} {k + 1}") for k in range(TWICE))), ())
    return sum(len(runs) + k in again.fitted for k in range(TWICE)) / TWICE


def by_table(pair: set[str]) -> NextRun:
    """What is known to separate some effects where no run of the catalogue is expected to by its numbers."""
    for members, procedure, conditions, why in DECIDERS:
        if len(members & pair) >= 2:
            return NextRun(procedure, dict(conditions), f"separates {' from '.join(sorted(pair))}: {why}")
    return NextRun("constant_torque", {"speed_rpm": 500.0}, f"separates {' from '.join(sorted(pair))} by speed")


def along(coordinate: str) -> NextRun | None:
    """The run that shows most of what nobody can name: along the `coordinate` of the report's list it lives in."""
    for coordinates, procedure, conditions, why in ALONG:
        if coordinate in coordinates:
            because = f"shows more of what lives in {coordinate}: {why}".replace("_", " ")
            return NextRun(procedure, dict(conditions), because)
    return None


EVERY_SPEED: Final[Mapping[str, float | bool | str]] = {
    "speeds_rpm": "15,30,60,120,200,310,400,500",
    "output_deg": 4.0,
    "breakaways": 1,
}
ALONG: Final[Sequence[tuple[frozenset[str], str, Mapping[str, float | bool | str], str]]] = (
    (
        frozenset({"speed", "time", "temperature", "direction"}),
        "friction",
        EVERY_SPEED,
        "every speed both ways within three minutes",
    ),
    (frozenset({"load", "memory"}), "stiffness_lock", {}, "nested amplitudes against the lock pin"),
    (frozenset({"load_angle", "motor_angle"}), "full_turn", {}, "a whole turn of the output"),
    (frozenset({"time_periodic"}), "standstill", {}, "what comes from outside stays when nothing turns"),
)

DECIDERS: Final[Sequence[tuple[frozenset[str], str, Mapping[str, float | bool | str], str]]] = (
    (
        frozenset({"thermal_friction_drift", "quadratic_drag", "stribeck_friction"}),
        "friction",
        EVERY_SPEED,
        "every speed from creep to fast within three minutes, rising and falling: at two or three speeds, minutes "
        "apart, falling friction, drag and warming bend the same curve",
    ),
    (
        frozenset({"nonlinear_stiffness", "hysteretic_stiffness", "lost_motion"}),
        "stiffness_lock",
        {"output_locked": True},
        "nested amplitudes show whether the branches meet",
    ),
    (
        frozenset({"output_once_per_rev", "torque_sensor_crosstalk", "gravity_unbalance"}),
        "constant_torque",
        {"speed_rpm": 400.0},
        "a real angle error makes torque when it turns fast",
    ),
)
