"""At the load angle of lock tests by itself: a housing that moves under the encoder is in no wind-up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import design, extended, fit
from rig.analysis.tracing.fit.search import Found, settled
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import Campaign, looking
from rig.analysis.tracing.runs.giving_way import gives_way
from rig.analysis.tracing.searched import beside
from rig.analysis.tracing.selection.select import select
from rig.analysis.tracing.selection.selected import Selected
from rig.model.effects.support_compliance import StiffSupport

MOVES: Final = StiffSupport()


def wanted(selected: Selected) -> bool:
    """Whether a load that is held gives way, in unseen lock tests too, and nothing is named that moves."""
    return MOVES.name not in selected.names and gives_way(selected.p.eq.runs)


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """A housing that moves beside what stands, with the load angle of lock tests by itself. It counts where it is named
    beside all that had a name, and as much is explained."""
    seen = so_far.p.campaign.runs
    p = prepare(looking(campaign, [replace(run.look, held_load=run.locked) for run in seen]), hold_out)
    fitted = p.split.fitted
    covered = reach([p.eq.runs[i] for i in fitted])
    d = design(p.eq, so_far.solution.design.terms, fitted)
    (shape,) = MOVES.shapes(covered)
    p, s = beside(p, settled(fit(extended(d, Term(MOVES, shape), fitted)), fitted, covered), covered)
    other = select(p, Found(s, found.ranking), fitted, covered)
    counts = other.names == {MOVES.name, *so_far.names} and (so_far.loud or not other.loud)
    return (other, found) if counts else (so_far, found)
