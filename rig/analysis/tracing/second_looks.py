"""Second looks at a campaign, each at what the first leaves out, where something outside of the equations asks for it.

They only add: the first selection stands unless the look names what it was for, beside all that had a name but for
what lay in its shadow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import design, extended, fit
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, reduced, settled
from rig.analysis.tracing.floor.homed import about_a_line
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.building_up import builds_up
from rig.analysis.tracing.runs.campaign import Campaign
from rig.analysis.tracing.runs.giving_way import gives_way
from rig.analysis.tracing.searched import beside, searched
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.selected import Selected, select
from rig.analysis.tracing.thresholds import SHADOW
from rig.model.effect import Reach
from rig.model.effects.channel_time_skew import ChannelTimeSkew
from rig.model.effects.presliding_friction import MOTOR, PreslidingFriction
from rig.model.effects.support_compliance import StiffSupport

BUILDS_UP: Final = PreslidingFriction()
MOVES: Final = StiffSupport()
LATE: Final = ChannelTimeSkew.name


def second_looks(
    selected: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]
) -> tuple[Selected, Found]:
    """What stands after all: around reversals, at the load angle of lock tests, and at the zeros of runs."""
    fitted = [selected.p.eq.runs[i] for i in selected.p.split.fitted]
    if BUILDS_UP.name not in selected.names and builds_up(fitted):
        selected, found = looked_closely(selected, found, campaign, hold_out)
    if MOVES.name not in selected.names and gives_way(fitted):
        selected, found = unwound(selected, found, campaign, hold_out)
    if LATE not in selected.names and about_a_line(selected.solution) is not None:
        selected, found = with_homed_encoders(selected, found, campaign, hold_out)
    return selected, found


def looked_closely(
    so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]
) -> tuple[Selected, Found]:
    """Friction that builds up beside what stands, with the rows around reversals that no equation holds in where
    friction jumps."""
    p = prepare(replace(campaign, runs=tuple(replace(run, closely=True) for run in campaign.runs)), hold_out)
    runs = p.split.fitted
    covered = reach([p.eq.runs[i] for i in runs])
    d = design(p.eq, so_far.solution.design.terms, runs)
    shapes = [Term(BUILDS_UP, shape) for shape in BUILDS_UP.shapes(covered) if shape[0] == MOTOR]
    if not shapes:
        return so_far, found
    first = max(shapes, key=lambda term: fit(extended(d, term, runs)).gain)
    p, s = beside(p, settled(refine(d, first, runs, covered)[1], runs, covered), covered)
    other = select(p, Found(s, found.ranking), runs, covered)
    if not _adds(other, so_far):
        return so_far, found
    return _out_of_its_shadow(other, found, runs, covered), found


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


def unwound(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """A housing that moves beside what stands, with the load angle of lock tests by itself. It counts where it is named
    beside all that had a name, and as much is explained."""
    runs = tuple(replace(run, unwound=run.locked) for run in so_far.p.campaign.runs)
    p = prepare(replace(campaign, runs=runs), hold_out)
    fitted = p.split.fitted
    covered = reach([p.eq.runs[i] for i in fitted])
    d = design(p.eq, so_far.solution.design.terms, fitted)
    (shape,) = MOVES.shapes(covered)
    p, s = beside(p, settled(fit(extended(d, Term(MOVES, shape), fitted)), fitted, covered), covered)
    other = select(p, Found(s, found.ranking), fitted, covered)
    counts = other.names == {MOVES.name, *so_far.names} and (so_far.loud or not other.loud)
    return (other, found) if counts else (so_far, found)


def with_homed_encoders(
    so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]
) -> tuple[Selected, Found]:
    """The same where what shifts a run's zero is no zero of its own. It counts where it names a reading that comes late
    and nothing else more, and explains everything."""
    runs = tuple(replace(run, homed=True) for run in so_far.p.campaign.runs)
    other, ranked = searched(prepare(replace(campaign, runs=runs), hold_out))
    late = not other.loud and other.names == {LATE, *so_far.names}
    return (other, ranked) if late else (so_far, found)
