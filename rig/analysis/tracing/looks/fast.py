"""At fast rows: a mode above what the first look compares, or near the end of that, where it knows few of its sides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.bank import fill, reach, torque_noise
from rig.analysis.tracing.fit.encoder_lines import with_lines
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, design, fit
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, Scored, settled, still
from rig.analysis.tracing.fit.some import ranking_of_some, some
from rig.analysis.tracing.prepared import Prepared, prepare
from rig.analysis.tracing.residual.above_the_band import has_fast_rows, rings_above
from rig.analysis.tracing.runs.campaign import Campaign, read_again
from rig.analysis.tracing.runs.holdout import split
from rig.analysis.tracing.searched import Tried, beside
from rig.analysis.tracing.selection.certain import is_calm, is_certain
from rig.analysis.tracing.selection.confounders import of_the_library
from rig.analysis.tracing.selection.select import select
from rig.analysis.tracing.selection.selected import Selected
from rig.analysis.tracing.thresholds import LAWS, NEARLY
from rig.core.errors import UsageError
from rig.model.effect import Reach
from rig.model.effects.support_compliance import StiffSupport, SupportCompliance
from rig.model.effects.torsional_mode import COUPLINGS, TorsionalMode

MODES: Final = (TorsionalMode(), SupportCompliance())
NAMES: Final = frozenset(mode.name for mode in MODES)
# nats of a mode beside what had a name: what the laws of other effects have wrong up there came to 150 in three
# campaigns, modes of 1.5 to 4 floors to 1300 and more
PLAIN: Final = 400.0


def wanted(selected: Selected) -> bool:
    """Whether a mode is named, or something rings above what was compared; and there are rows to tell it by."""
    if not any(has_fast_rows(run) for run in selected.fitted_runs):
        return False
    modes = [term for term in selected.solution.design.terms if term.name in NAMES]
    if any(term.shape[0] in COUPLINGS for term in modes if term.name == TorsionalMode.name):
        return False  # the load tells how a wave generator turns, and what is fast of that is mostly noise
    swings = any(not isinstance(term.effect, StiffSupport) for term in modes)
    return swings or rings_above(selected.solution, selected.p.floors)


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """A mode beside all else that has a name, with a low-pass twice as wide. One order meets it at one speed or two,
    whose runs may all be fitted ones: then other repeats are held out."""
    again = read_again(so_far.p.campaign, fast=True)
    if again is None:
        return so_far, found
    ways = [split(again.runs, hold_out, swapped).held_out for swapped in (False, True)]
    for swapped in (False, True) if ways[0] != ways[1] else (False,):
        p = _prepared(again, hold_out, swapped)
        if p is None:
            continue
        start = fit(design(p.eq, _kept(so_far), p.split.fitted))
        ranked = _ranked(p, start, _covered(p)) if _shows_a_mode(p, start, _covered(p)) else ()
        if ranked and ranked[0].term.name not in NAMES:
            break  # something else explains more, and of other repeats of the same it would as well
        if (made := _beside(so_far, found, p, start, ranked)) is not None:
            return made
    return so_far, found


def _kept(so_far: Selected) -> list[Term]:
    """What had a name but for modes."""
    return [term for term in so_far.solution.design.terms if term.name not in NAMES]


def _beside(
    so_far: Selected, found: Found, p: Prepared, start: Solution, ranked: Sequence[Scored]
) -> tuple[Selected, Found] | None:
    """None where no mode counts."""
    covered, calm = _covered(p), not _kept(so_far) and (still(start, p.floors) or is_calm(p))
    for law in [law for one in ranked if one.term.name in NAMES for law in (one.term, *one.laws)]:
        other = _with(law, p, start, covered, calm)
        if _counts(other, so_far) and not (calm and not is_certain(other, p.held_out)):
            return other, replace(found, ranking=_together(found.ranking, ranked))
    return None


def _prepared(again: Campaign, hold_out: Sequence[str], swapped: bool) -> Prepared | None:
    """None where they are too noisy to be fitted: what was told stands as well."""
    try:
        return prepare(again, hold_out, swapped)
    except UsageError:
        return None


def _counts(other: Selected, so_far: Selected) -> bool:
    """Whether one mode is named, nothing else that had none, and as much is explained. What had a name may lose it
    where fast rows tell more: a coupling that swings above the first look's band is a motor angle read late there; or
    where it does less than the mode, beside a rest that the mode explains: the motor's torque has more noise here."""
    kept = so_far.names - NAMES
    if len(other.names & NAMES) != 1 or not other.names - NAMES <= kept:
        return False
    lost = [score for score in so_far.scores if score.name in kept - other.names]
    if not lost:
        return so_far.loud or not other.loud
    told_better = all(channel in ("A", "L") for score in lost for _, channel in score.ground)
    mode = next(score.size for score in other.scores if score.name in NAMES)
    small = so_far.loud and all(score.size < mode for score in lost)
    return (told_better or small) and not other.loud


def _covered(p: Prepared) -> Reach:
    return replace(reach([p.eq.runs[i] for i in p.split.fitted]), torque_noise=torque_noise(p.eq))


def _shows_a_mode(p: Prepared, start: Solution, covered: Reach) -> bool:
    """Whether a mode explains plainly more than `start` does: a fifth of the time that all effects take."""
    runs = p.split.fitted
    bank = fill(some(p.eq.afresh(), runs), MODES, runs, covered)
    ranking = ranking_of_some(start.design, bank, runs, covered, NEARLY)
    return any(mode.evidence > PLAIN for mode in ranking)


def _ranked(p: Prepared, start: Solution, covered: Reach) -> Sequence[Scored]:
    """Effects of the library by what they explain beside `start`, the best shape of each with its other laws."""
    runs = p.split.fitted
    bank = Tried(p, with_lines(covered, start, runs)).bank
    ranking = ranking_of_some(start.design, bank, runs, covered, LAWS)
    return sorted(ranking, key=lambda one: -one.evidence)


def _with(law: Term, p: Prepared, start: Solution, covered: Reach, calm: bool) -> Selected:
    """What stands of `start` and a law of a mode: which law it is shows in runs that no fit has seen."""
    runs = p.split.fitted
    refined = settled(refine(start.design, law, runs, covered)[1], runs, covered)
    again, s = beside(p, refined, covered)
    again = replace(again, held_out=replace(again.held_out, calm=calm))
    return select(again, Found(s, ()), runs, covered)


def _together(first: Sequence[Scored], ranked: Sequence[Scored]) -> tuple[Scored, ...]:
    """Candidates of the first look, and modes as the second one has them, by evidence."""
    both = [one for one in first if one.term.name not in NAMES] + [one for one in ranked if one.term.name in NAMES]
    return of_the_library(tuple(sorted(both, key=lambda one: -one.evidence)))
