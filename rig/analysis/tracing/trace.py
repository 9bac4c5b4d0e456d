"""One trace from a folder to a result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rig.analysis.tracing.fit.bank import Bank, fill, reach
from rig.analysis.tracing.fit.encoder_lines import with_lines
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.fit.search import Found, relawed, still
from rig.analysis.tracing.fit.some import search_some, some
from rig.analysis.tracing.floor.noise import measure, quieter
from rig.analysis.tracing.floor.own import find
from rig.analysis.tracing.outcome.report import report
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.prepared import Prepared, built, prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.selection.confounders import CONFOUNDERS, of_the_library
from rig.analysis.tracing.selection.further import select_further
from rig.analysis.tracing.selection.selected import is_calm, is_certain, select
from rig.analysis.tracing.workers import give_back, one_heap
from rig.model.effect import Reach
from rig.model.effects import CATALOGUE


def trace(folder: Path, hold_out: Sequence[str] = ()) -> Trace:
    """Trace the campaign in `folder`. Raises UsageError when it cannot be read or has too little to fit and test."""
    one_heap()
    campaign = read_campaign(folder)
    give_back()
    p = prepare(campaign, hold_out)
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
    found = replace(found, ranking=of_the_library(found.ranking))
    return report(selected.p, found, selected.solution, selected.held, selected.scores, selected.words)


def _looked_again(p: Prepared, found: Found, bank: Bank, covered: Reach) -> tuple[Prepared, Found]:
    """What each run has to itself and the floor, looked for beside the effects that were found, and what they uncover.

    A large effect in the model's want hides lost counts, looks like them, and makes repeats differ.
    """
    runs, s = p.split.fitted, found.solution
    if not s.design.terms:
        return p, found
    eq = s.design.eq
    free = s if not eq.own else replace(s, design=design(replace(eq, own={}), s.design.terms, runs))
    own = find(free, p.split)
    columns = own.columns()
    # what a rough search found was fitted to all rows just now
    same = found.rough and not eq.own and not columns
    with_own = s if same else fit(design(replace(eq, own=columns), s.design.terms, runs))
    measured = quieter(p.measured, measure(with_own, runs))
    if any(term.effect.remembers for term in s.design.terms):
        measured = replace(measured, noise=measured.noise.free("A"))
    again = replace(built(p.campaign, p.split, eq, measured, own), first=p.first)
    s = relawed(fit(design(again.eq, s.design.terms, runs)), runs, covered)
    return again, search_some(s.design, bank, runs, covered, again.floors, ranking=found.ranking)
