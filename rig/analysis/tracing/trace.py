"""One trace from a folder to a result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from rig.analysis.tracing.fit.bank import Bank, fill, reach
from rig.analysis.tracing.fit.encoder_lines import with_lines
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, design, extended, fit
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, reduced, relawed, settled, still
from rig.analysis.tracing.fit.some import search_some, some
from rig.analysis.tracing.floor.homed import about_a_line
from rig.analysis.tracing.floor.noise import measure, quieter
from rig.analysis.tracing.floor.own import find
from rig.analysis.tracing.outcome.report import report
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.prepared import Prepared, built, prepare
from rig.analysis.tracing.runs.building_up import builds_up
from rig.analysis.tracing.runs.campaign import Campaign, read_campaign
from rig.analysis.tracing.selection.confounders import CONFOUNDERS, of_the_library
from rig.analysis.tracing.selection.further import select_further
from rig.analysis.tracing.selection.selected import Selected, is_calm, is_certain, select
from rig.analysis.tracing.thresholds import SHADOW
from rig.analysis.tracing.workers import give_back, one_heap
from rig.model.effect import Reach
from rig.model.effects import CATALOGUE
from rig.model.effects.channel_time_skew import ChannelTimeSkew
from rig.model.effects.presliding_friction import MOTOR, PreslidingFriction

BUILDS_UP: Final = PreslidingFriction()
LATE: Final = ChannelTimeSkew.name


def trace(folder: Path, hold_out: Sequence[str] = ()) -> Trace:
    """Trace the campaign in `folder`. Raises UsageError when it cannot be read or has too little to fit and test."""
    one_heap()
    campaign = read_campaign(folder)
    give_back()
    selected, found = _selected(prepare(campaign, hold_out))
    if BUILDS_UP.name not in _named(selected) and builds_up([selected.p.eq.runs[i] for i in selected.p.split.fitted]):
        selected, found = _looked_closely(selected, found, campaign, hold_out)
    if LATE not in _named(selected) and about_a_line(selected.solution) is not None:
        selected, found = _with_homed_encoders(selected, found, hold_out)
    return report(selected.p, found, selected.solution, selected.held, selected.scores, selected.words)


def _looked_closely(
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
    p, s = _beside(p, settled(refine(d, first, runs, covered)[1], runs, covered), covered)
    other = select(p, Found(s, found.ranking), runs, covered)
    if not _adds(other, so_far):
        return so_far, found
    return _out_of_its_shadow(other, found, runs, covered), found


def _out_of_its_shadow(other: Selected, found: Found, runs: Sequence[int], covered: Reach) -> Selected:
    """Without what had a name before for what is left of friction that builds up, if nothing is left without it."""
    mine = next(score.size for score in other.scores if score.name == BUILDS_UP.name)
    small = {score.name for score in other.scores if SHADOW * score.size < mine}
    d = other.solution.design
    gone = [i for i, term in enumerate(d.terms) if term.name in small]
    if not gone:
        return other
    fewer = select(other.p, Found(fit(reduced(d, gone)), found.ranking), runs, covered)
    return other if fewer.loud or BUILDS_UP.name not in _named(fewer) else fewer


def _with_homed_encoders(so_far: Selected, found: Found, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """The same where what shifts a run's zero is no zero of its own. It counts where it names a reading that comes late
    and nothing else more, and explains everything."""
    runs = tuple(replace(run, homed=True) for run in so_far.p.campaign.runs)
    other, ranked = _selected(prepare(replace(so_far.p.campaign, runs=runs), hold_out))
    late = not other.loud and _named(other) == {LATE, *_named(so_far)}
    return (other, ranked) if late else (so_far, found)


def _adds(other: Selected, so_far: Selected) -> bool:
    """Whether what builds up is named now, beside all that had a name before but for what lay in its shadow."""
    mine = next((score for score in other.scores if score.name == BUILDS_UP.name), None)
    if mine is None or (other.loud and not so_far.loud):
        return False
    lost = [score for score in so_far.scores if score.name not in _named(other)]
    return all(SHADOW * score.size < mine.size for score in lost)


def _named(selected: Selected) -> set[str]:
    return {term.name for term in selected.solution.design.terms}


def _selected(p: Prepared) -> tuple[Selected, Found]:
    """What stands of all that was searched for, and the candidates of the library."""
    runs = p.split.fitted
    covered = reach([p.eq.runs[i] for i in runs])
    start = fit(design(p.eq, (), runs))
    quiet = still(start, p.floors)
    covered = with_lines(covered, start, runs)
    candidates = [
        *CATALOGUE.values(),
        *(confounder.effect for confounder in CONFOUNDERS.values() if confounder.searched),
    ]
    # what hundreds of shapes keep with the signals they are made of is a tenth of a gigabyte, and done with
    bank = fill(some(p.eq.afresh(), runs), candidates, runs, covered)
    found = search_some(start.design, bank, runs, covered, p.floors, quiet=quiet)
    give_back()
    again, found = _looked_again(p, found, bank, covered)
    give_back()
    selected = select(again, found, runs, covered)
    if not quiet:
        selected = select_further(selected, found, bank, runs, covered)
    if (quiet or is_calm(p)) and not is_certain(selected):
        found = Found(start, found.ranking)
        selected = select(p, found, runs, covered)
    del bank  # half a gigabyte, and the report is made by two processes
    give_back()
    return selected, replace(found, ranking=of_the_library(found.ranking))


def _looked_again(p: Prepared, found: Found, bank: Bank, covered: Reach) -> tuple[Prepared, Found]:
    """What each run has to itself and the floor, looked for beside the effects that were found, and what they uncover.

    A large effect in the model's want hides lost counts, looks like them, and makes repeats differ.
    """
    if not found.solution.design.terms:
        return p, found
    again, s = _beside(p, found.solution, covered, found.rough)
    return again, search_some(s.design, bank, p.split.fitted, covered, again.floors, ranking=found.ranking)


def _beside(p: Prepared, s: Solution, covered: Reach, rough: bool = False) -> tuple[Prepared, Solution]:
    """Prepared anew beside effects that were found, and they fitted to that. What a `rough` search found was fitted to
    all rows just now."""
    runs = p.split.fitted
    eq = s.design.eq
    free = s if not eq.own else replace(s, design=design(replace(eq, own={}), s.design.terms, runs))
    own = find(free, p.split)
    columns = own.columns()
    same = rough and not eq.own and not columns
    with_own = s if same else fit(design(replace(eq, own=columns), s.design.terms, runs))
    measured = quieter(p.measured, measure(with_own, runs))
    if any(term.effect.remembers for term in s.design.terms):
        measured = replace(measured, noise=measured.noise.free("A"))
    again = replace(built(p.campaign, p.split, eq, measured, own), first=p.first)
    return again, relawed(fit(design(again.eq, s.design.terms, runs)), runs, covered)
