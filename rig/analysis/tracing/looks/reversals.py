"""Around reversals: friction that builds up, in the rows that no equation holds in where friction jumps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Design, Solution, design, extended, fit
from rig.analysis.tracing.fit.refine import in_its_law, refine
from rig.analysis.tracing.fit.search import Found, reduced, settled
from rig.analysis.tracing.prepared import Prepared, prepare
from rig.analysis.tracing.runs.building_up import builds_up
from rig.analysis.tracing.runs.campaign import Campaign, looking
from rig.analysis.tracing.searched import beside
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.select import select
from rig.analysis.tracing.selection.selected import Selected
from rig.analysis.tracing.thresholds import SHADOW
from rig.model.effect import Reach
from rig.model.effects.presliding_friction import BRISTLE, MOTOR, PreslidingFriction

BUILDS_UP: Final = PreslidingFriction()


def wanted(selected: Selected) -> bool:
    """Whether friction is seen to build up, and has no name."""
    return BUILDS_UP.name not in selected.names and bool(builds_up(selected.fitted_runs))


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """Friction that builds up beside what stands, with the rows around reversals that no equation holds in where
    friction jumps: of those runs alone in which it is seen to. A motor that turns goes over its way between two rows
    where one of a lock test takes many."""
    for locked in builds_up(so_far.fitted_runs):
        if BUILDS_UP.name not in so_far.names:
            looks = [replace(run.look, reversals=run.locked is locked) for run in campaign.runs]
            so_far, found = _looked(so_far, found, prepare(looking(campaign, looks), hold_out))
    return so_far, found


def _looked(so_far: Selected, found: Found, p: Prepared) -> tuple[Selected, Found]:
    """What stands after a look at the reversals of some runs."""
    runs = p.split.fitted
    covered = reach([p.eq.runs[i] for i in runs])
    d = design(p.eq, so_far.solution.design.terms, runs)
    shapes = [Term(BUILDS_UP, shape) for shape in BUILDS_UP.shapes(covered) if shape[0] == MOTOR]
    if not shapes:
        return so_far, found
    first = max(shapes, key=lambda term: fit(extended(d, term, runs)).gain)
    best = settled(refine(d, first, runs, covered)[1], runs, covered)
    for built in (best, *_of_one_bristle(d, best, runs, covered)):
        again, s = beside(p, built, covered)
        other = select(again, Found(s, found.ranking), runs, covered)
        if _adds(other, so_far):
            return _out_of_its_shadow(other, found, runs, covered), found
    return so_far, found


def _of_one_bristle(d: Design, best: Solution, runs: Sequence[int], covered: Reach) -> tuple[Solution, ...]:
    """The plain law, where several elements or bristles fit better: over less than the motor goes between two samples
    nothing tells them from each other, and what cannot be told has no name."""
    term = best.design.terms[-1]
    if term.shape[2] == BRISTLE:
        return ()
    return (in_its_law(d, replace(term, shape=(MOTOR, term.shape[1], BRISTLE)), runs, covered)[1],)


def _out_of_its_shadow(other: Selected, found: Found, runs: Sequence[int], covered: Reach) -> Selected:
    """Without what had a name before for what is left of friction that builds up, if nothing is left without it."""
    mine = _built_up(other)
    small = {score.name for score in other.scores if mine is not None and _in_its_shadow(score, mine)}
    d = other.solution.design
    gone = [i for i, term in enumerate(d.terms) if term.name in small]
    if not gone:
        return other
    fewer = select(other.p, Found(fit(reduced(d, gone)), found.ranking), runs, covered)
    return other if fewer.loud or BUILDS_UP.name not in fewer.names else fewer


def _adds(other: Selected, so_far: Selected) -> bool:
    """Whether what builds up is named now, beside all that had a name before but for what lay in its shadow."""
    mine = _built_up(other)
    if mine is None or (other.loud and not so_far.loud):
        return False
    lost = [score for score in so_far.scores if score.name not in other.names]
    return all(_in_its_shadow(score, mine) for score in lost)


def _built_up(selected: Selected) -> HeldOutScore | None:
    return next((score for score in selected.scores if score.name == BUILDS_UP.name), None)


def _in_its_shadow(one: HeldOutScore, mine: HeldOutScore) -> bool:
    """Whether an effect acts where the motor's friction does, and is a tenth of it: in other channels it is another."""
    return SHADOW * one.size < mine.size and {c for _, c in one.ground} <= {"M", "R"}
