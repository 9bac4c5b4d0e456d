"""At fast rows: a mode above what the first look compares, or near the end of that, where it knows few of its sides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.bank import fill, reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import design
from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.fit.some import ranking_of_some, some
from rig.analysis.tracing.prepared import Prepared, prepare
from rig.analysis.tracing.rest.above_the_band import has_fast_rows, rings_above
from rig.analysis.tracing.runs.campaign import Campaign, looking, read_campaign
from rig.analysis.tracing.runs.look import Look
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.selected import Selected
from rig.analysis.tracing.thresholds import NEARLY
from rig.model.effects.support_compliance import SupportCompliance
from rig.model.effects.torsional_mode import TorsionalMode

MODES: Final = (TorsionalMode(), SupportCompliance())
NAMES: Final = frozenset(mode.name for mode in MODES)
# nats of a mode beside what had a name: what the laws of other effects have wrong up there came to 150 in three
# campaigns, modes of 1.5 to 4 floors to 1300 and more
PLAIN: Final = 400.0


def wanted(selected: Selected) -> bool:
    """Whether a mode is named, or something rings above what was compared; and there are rows to tell it by."""
    if not any(has_fast_rows(run) for run in selected.fitted_runs):
        return False
    return not NAMES.isdisjoint(selected.names) or rings_above(selected.solution, selected.p.floors)


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """All of it once more with a low-pass twice as wide, where that shows a mode. It counts where it names one mode, or
    the one that had a name, beside all else that had one, and as much is explained."""
    first = so_far.p.campaign
    again = read_campaign(first.folder, Look(fast=True))
    p = prepare(looking(again, [replace(run.look, fast=True) for run in first.runs]), hold_out)
    if not _shows_a_mode(p, [term for term in so_far.solution.design.terms if term.name not in NAMES]):
        return so_far, found
    other, ranked = searched(p)
    beside = so_far.names - NAMES
    mine = other.names & NAMES
    counts = other.names == beside | mine and len(mine) == 1 and (so_far.loud or not other.loud)
    return (other, ranked) if counts else (so_far, found)


def _shows_a_mode(p: Prepared, beside: Sequence[Term]) -> bool:
    """Whether a mode explains plainly more than those terms do: a fifth of the time that all effects take."""
    runs = p.split.fitted
    covered = reach([p.eq.runs[i] for i in runs])
    bank = fill(some(p.eq.afresh(), runs), MODES, runs, covered)
    ranking = ranking_of_some(design(p.eq, beside, runs), bank, runs, covered, NEARLY)
    return any(mode.evidence > PLAIN for mode in ranking)
