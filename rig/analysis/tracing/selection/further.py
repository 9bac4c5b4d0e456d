"""Further selections, where the first explained little or left something uncertain.

The search takes the best candidate first. A look-alike that comes before the true effect is eliminated on unseen runs,
and the true one was never tried; late terms that chase a rest take a true one's size with them.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from rig.analysis.tracing.fit.bank import Bank
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Design, design, extended, fit
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, Scored, reduced, settled
from rig.analysis.tracing.fit.some import ranking_of_some, search_some
from rig.analysis.tracing.floor.held_out import unseen
from rig.analysis.tracing.selection.candidates import tried
from rig.analysis.tracing.selection.confounders import CONFOUNDERS, confounders_in
from rig.analysis.tracing.selection.elimination import scales
from rig.analysis.tracing.selection.instead_of import FRICTIONS, below_zero
from rig.analysis.tracing.selection.select import select
from rig.analysis.tracing.selection.selected import Selected
from rig.analysis.tracing.thresholds import ALIKE, EXPLAINED, KNOWN, LAWS, MISSING, MOSTLY, NAMED, OUTDONE, TRIED, TURNS
from rig.model.effect import Reach
from rig.process.workers import first_that


def select_further(selected: Selected, found: Found, bank: Bank, runs: Sequence[int], covered: Reach) -> Selected:
    """All of them, one after the other: each has its own reason, and most campaigns none."""
    selected = try_prefixes(selected, found, runs, covered)
    selected = try_instead_of_eliminated(selected, found, runs, covered)
    selected = try_without_eliminated(selected, found, bank, runs, covered)
    selected = try_without_each(selected, found, bank, runs, covered)
    selected = try_each_added(selected, found, bank, runs, covered)
    return without_outdone(try_each_instead(selected, found, runs, covered), found, runs)


def try_prefixes(selected: Selected, found: Found, runs: Sequence[int], covered: Reach) -> Selected:
    """Where much is left and something was eliminated: what the search found first, without what came later. A true
    effect whose law is a little off leaves a rest that late terms chase, and beside those it has not its size any more.
    What leaves least on unseen runs counts, where no name is lost by it; with the names there are, where it explains
    everything: one more term of an effect may be all that its first law wanted (exam 92, case 35)."""
    terms = found.solution.design.terms
    stay = {term.name for term in selected.solution.design.terms}
    if selected.p.own.line is not None or not selected.loud or not found.names or stay >= set(found.names):
        return selected
    ends = [i for i in range(1, len(terms)) if terms[i].name != terms[i - 1].name][:TURNS]
    for end in ends:
        s = fit(reduced(found.solution.design, range(end, len(terms))))
        other = select(selected.p, replace(found, solution=s), runs, covered)
        stands = {term.name for term in other.solution.design.terms}
        # a law without a name is asked only where something is left
        more = stands - stay - (frozenset() if selected.loud else CONFOUNDERS.keys())
        settles = stay == stands and selected.loud and not other.loud
        if (settles or (more and stay < stands)) and other.left < selected.left:
            selected, stay = other, stands
    return selected


def try_instead_of_eliminated(selected: Selected, found: Found, runs: Sequence[int], covered: Reach) -> Selected:
    """Where much is left: look-alikes of what was eliminated, each in its place and all the others beside it. Friction
    that falls up to the fastest run is a drag with a law at the end of its range, and goes for that; without it what
    stands beside it has no size of its own any more. One of them counts where more names stand, and it explains
    everything or all there is."""
    stay = {term.name for term in selected.solution.design.terms}
    if selected.p.own.line is not None or not selected.loud:
        return selected
    evidence = {r.term.name: r.evidence for r in found.ranking}
    d = found.solution.design
    for gone in [name for name in found.names if name not in stay][:TRIED]:
        but = {*found.names, *selected.taken}
        least = ALIKE * evidence.get(gone, np.inf)
        alike = [r.term for r in found.ranking if r.term.name not in but and r.evidence > least][:TRIED]
        bare = reduced(d, [i for i, other in enumerate(d.terms) if other.name == gone])

        def in_its_place(term: Term, bare: Design = bare) -> Selected | None:
            s = settled(refine(bare, term, runs, covered)[1], runs, covered)
            other = select(selected.p, replace(found, solution=s), runs, covered)
            more = stay < {term.name for term in other.solution.design.terms}
            return other if more and (_settles(other, stay) or _takes_most(other, selected)) else None

        if (other := first_that(in_its_place, alike)) is not None:
            return other
    return selected


def try_without_eliminated(
    selected: Selected, found: Found, bank: Bank, runs: Sequence[int], covered: Reach
) -> Selected:
    """Where much is left, those that were not tried for want of room: without all the eliminated ones, and without the
    one that came first alone, for it may have spoilt the others' size. They count when they explain everything; else
    the first selection stands."""
    stay = {term.name for term in selected.solution.design.terms}
    eliminated = [name for name in found.names if name not in stay]
    if not eliminated or selected.p.own.line is not None or not selected.loud:
        return selected

    def without(gone: frozenset[str]) -> Selected | None:
        """What is selected without those, where it counts."""
        d, but = selected.solution.design, gone | selected.taken
        others = search_some(d, bank, runs, covered, selected.p.floors, ranking=found.ranking, excluded=but)
        if not set(others.names) - stay:
            return None
        other = select(selected.p, others, runs, covered)
        stands = _settles(other, stay) or _stands_alone(other, stay)
        return other if stands and not _stands_in(other, stay, found, gone, runs) else None

    return first_that(without, list(dict.fromkeys(map(frozenset, (eliminated, eliminated[:1]))))) or selected


def try_without_each(selected: Selected, found: Found, bank: Bank, runs: Sequence[int], covered: Reach) -> Selected:
    """Where much is left beside several names: what is found without one of them, the others in the model from the
    start. A second inertia in the place of an encoder's lines takes most of the motor's; beside what is left of that
    the lines, once they are found, cannot do without it. It counts when fewer names leave less of unseen runs, or when
    all the others stand and explain everything."""
    names = {score.name for score in selected.scores}
    if len(names) < 2 or selected.p.own.line is not None or not selected.loud:
        return selected

    def without(name: str) -> Selected | None:
        """What is selected without that one, where it counts."""
        terms = selected.solution.design.terms
        bare = reduced(selected.solution.design, [i for i, term in enumerate(terms) if term.name == name])
        d = settled(fit(bare), runs, covered).design
        but = selected.taken | {name}
        others = search_some(d, bank, runs, covered, selected.p.floors, ranking=found.ranking, excluded=but)
        other = select(selected.p, others, runs, covered)
        same = replace(other, p=selected.p)  # by the same floors: without repeats they are measured beside the effects
        fewer = other.names <= names - {name} and same.left < selected.left
        settles = names - {name} <= other.names and _settles(same, names) and _is_of_a_gear(other, selected)
        return other if fewer or settles else None

    return first_that(without, sorted(names)) or selected


def _is_of_a_gear(other: Selected, selected: Selected) -> bool:
    """Whether no friction of the motor is below zero that was above: a drag that takes its place may take any other
    effect's as well."""
    return below_zero(other.solution, FRICTIONS) <= below_zero(selected.solution, FRICTIONS)


def _stands_in(
    other: Selected, stay: Collection[str], found: Found, eliminated: Collection[str], runs: Sequence[int]
) -> bool:
    """Whether a name that came in for want of the eliminated ones explains less of the fitted runs than one of those in
    its place: a torque once a turn of the output for a torque sensor that is read so."""
    d = other.solution.design
    gone = [term for term in found.solution.design.terms if term.name in eliminated]
    for name in {term.name for term in d.terms} - set(stay):
        bare = reduced(d, [i for i, term in enumerate(d.terms) if term.name == name])
        if any(fit(extended(bare, term, runs)).gain > other.solution.gain for term in gone):
            return True
    return False


def try_each_added(selected: Selected, found: Found, bank: Bank, runs: Sequence[int], covered: Reach) -> Selected:
    """Where much is left: the candidates with most evidence at first, and those with most beside what stands, each
    alone beside it; the one effect that explained all there was of fitted runs in its other laws too. Many small ones
    that the search put beside the true effect can drive it out, or have it in a shape that is its own no more. One of
    them counts when it explains everything, or all there is where it acts."""
    if selected.p.own.line is not None or not selected.loud:
        return selected
    d = selected.solution.design
    stay = {term.name for term in d.terms}
    but = stay | selected.taken
    beside = ranking_of_some(d, bank, runs, covered, LAWS)
    only = [r for r in beside if found.names == (r.term.name,)]

    def added(term: Term) -> Selected | None:
        s = settled(refine(d, term, runs, covered)[1], runs, covered)
        other = select(selected.p, replace(found, solution=s), runs, covered)
        more = stay < {term.name for term in other.solution.design.terms}
        counts = more and (_settles(other, stay) or _stands_alone(other, stay) or _takes_most(other, selected))
        return other if counts else None

    terms = _in_all_laws(_most_of(found.ranking, but) + _most_of(beside, but), only)
    return first_that(added, terms) or selected


def _most_of(ranking: Sequence[Scored], stay: Collection[str]) -> list[Term]:
    return [r.term for r in ranking if r.term.name not in stay][:TRIED]


def _in_all_laws(terms: Sequence[Term], ranking: Sequence[Scored]) -> list[Term]:
    """Each of `terms` once, followed by the other laws of its effect that the `ranking` has: of two that explain nearly
    as much of fitted runs one may foretell unseen ones, and a look-alike is no answer before it was asked. Of an effect
    among others they are as many ways to fill in for what is none of them."""
    laws = {r.term.name: (r.term, *r.laws) for r in ranking}
    return list(dict.fromkeys(law for term in terms for law in (term, *laws.get(term.name, ()))))


def try_each_instead(selected: Selected, found: Found, runs: Sequence[int], covered: Reach) -> Selected:
    """Where the one effect that stands wants another size from run to run: look-alikes that explained nearly as much,
    each in its place. One that is steadier and leaves less of unseen runs is rather what it is."""
    names = {term.name for term in selected.solution.design.terms}
    if len(names) != 1 or len(selected.scores) != 1 or selected.scores[0].fairly:
        return selected
    mine = next((r.evidence for r in found.ranking if r.term.name in names), np.inf)
    alike = [r for r in found.ranking if r.term.name not in names | selected.taken and r.evidence > ALIKE * mine]
    for scored in alike[:TRIED]:
        s = settled(refine(selected.p.baseline.design, scored.term, runs, covered)[1], runs, covered)
        other = select(selected.p, replace(found, solution=s), runs, covered)
        if len(other.scores) == 1 and _steadier(other, selected) and _in_all(other) < _in_all(selected):
            selected = other
    return selected


def without_outdone(selected: Selected, found: Found, runs: Sequence[int]) -> Selected:
    """Without the one effect that stands where it wants another size from run to run, and another one explains far more
    of the fitted runs and all the same of unseen ones: it is a shadow of what that one is nearly."""
    names = [term.name for term in selected.solution.design.terms]
    if len(set(names)) != 1 or len(selected.scores) != 1 or selected.scores[0].fairly:
        return selected
    p, first = selected.p, found.ranking[0]
    mine = next((r.evidence for r in found.ranking if r.term.name == names[0]), np.inf)
    if first.evidence < OUTDONE * mine:
        return selected
    before = p.held_out.residuals(p.baseline, held := unseen(p.baseline, p.held_out))
    if tried(p, first, held, before).share < NAMED:
        return selected
    bare = fit(design(p.eq, (), runs))
    return Selected(p, bare, unseen(bare, p.held_out), [], {})


def _settles(other: Selected, stay: Collection[str]) -> bool:
    """Whether a second choice explains everything, and the numbers that scale its laws (a frequency, a torque) are
    known to a third of themselves: more is asked of it than that they are not zero, but where repeats vouch for it."""
    return not other.loud and _known(other, stay)


def _known(other: Selected, stay: Collection[str]) -> bool:
    vouched = {score.name for score in other.scores if score.as_repeats and score.fairly}
    new = {term.name for term in other.solution.design.terms if term.name not in stay} - vouched
    known = [p for name in new for p in scales(other.solution, name, other.words)]
    return all(p.ci95[1] - p.ci95[0] < 2 * KNOWN * abs(p.value) for p in known)


def _stands_alone(other: Selected, stay: Collection[str]) -> bool:
    """Whether a second choice explains nearly all of what it acts on with one size in all runs, in a channel in which
    nothing else that has a name acts: it is named though something is left beside it."""
    new = [score for score in other.scores if score.name not in stay]
    theirs = {c for score in other.scores if score.name in stay for _, c in score.ground}
    apart = all(c not in theirs for score in new for _, c in score.ground)
    plain = all(score.share > MOSTLY and score.fairly and score.left < MISSING for score in new)
    return apart and bool(new) and plain and not confounders_in(other.solution) and _known(other, stay)


def _takes_most(other: Selected, selected: Selected) -> bool:
    """Whether a second choice takes nearly all of what is left plainly, by names that are plain themselves: a law of a
    speed whose exponent is a little off leaves a mean at each speed, as loud to who asks for it as little beside it."""
    stay = {term.name for term in selected.solution.design.terms}
    new = [score for score in other.scores if score.name not in stay]
    over, then = other.left**2 - 1, selected.left**2 - 1
    most = selected.left > MISSING and other.left < EXPLAINED and over < (1 - MOSTLY) * then
    plain = bool(new) and all(score.named and score.plain for score in new)
    return most and plain and not confounders_in(other.solution) and _known(other, stay)


def _steadier(one: Selected, other: Selected) -> bool:
    return max(one.scores[0].unsteady, one.scores[0].apart) < max(other.scores[0].unsteady, other.scores[0].apart)


def _in_all(selected: Selected) -> float:
    """RMS over floor of all channels of unseen runs together."""
    left = selected.p.held_out.residuals(selected.solution, selected.held)
    return selected.p.held_out.ratio(left, list(left))
