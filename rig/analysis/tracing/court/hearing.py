"""What the search brought, before the court: which effects stay, and a second hearing where the first explained little.

The search takes the best suspect first. A look-alike that comes before the true effect is refused on unseen runs, and
the true one was never asked.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rig.analysis.tracing.court.judge import (
    Court,
    Worth,
    convicted,
    court,
    holds_zero,
    scales,
    unresolved,
    unseen,
)
from rig.analysis.tracing.court.shadows import cast, unmasked
from rig.analysis.tracing.fit.bank import Bank
from rig.analysis.tracing.fit.covariance import covariance, scatter
from rig.analysis.tracing.fit.model import Design, Solution, design, fit
from rig.analysis.tracing.fit.parameters import effects
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, polished, reduced, settled
from rig.analysis.tracing.fit.some import search_some
from rig.analysis.tracing.floor.noise import measure, quieter
from rig.analysis.tracing.floor.repeats import repeats
from rig.analysis.tracing.outcome.report import own_work
from rig.analysis.tracing.thresholds import MISSING, MOSTLY, NAMED, PLAIN_TO_SEE, QUIET
from rig.model.effect import Array, Parameter, Reach

if TYPE_CHECKING:
    from rig.analysis.tracing.trace import Prepared


KNOWN = 1 / 3  # of itself: half a 95 % interval
ALONE_TRIED = 2  # suspects: each costs a hearing
ALIKE = 0.8  # of its evidence: a look-alike that may be what it is
TURNS = 4  # effects the search found first, one after the other

Words = dict[str, tuple[Parameter, ...]]
"""Parameters by effect."""


@dataclass(frozen=True)
class Heard:
    """The model with the effects that may be named, on the held-out runs, and their parameters in words."""

    p: Prepared
    solution: Solution
    held: Design
    worths: list[Worth]
    words: Words

    @property
    def loud(self) -> bool:
        """Whether more is left on the held-out runs than may be."""
        return is_loud(self.p.court, self.solution, self.held)


def heard(p: Prepared, found: Found, runs: Sequence[int], covered: Reach) -> Heard:
    """Effects are refused until all that are left may be named; their laws are fitted again beside each other."""
    solution, held, worths = convicted(found.solution, p.court)
    if len(solution.design.terms) < len(found.solution.design.terms):
        p = _floored(p, solution, runs)
        solution, held, worths = convicted(solution, p.court)
    fewer = len(solution.design.terms) < len(found.solution.design.terms)
    if fewer or found.rough or len(solution.design.terms) > 1:
        solution, held, worths = _polished(p, solution, (solution, held, worths), runs, covered)
    p, solution = _own_convicted(p, solution)
    solution, held, worths = convicted(unmasked(solution, runs, covered), p.court)
    while vague := unresolved(solution, _in_words(solution, runs, scatter), covered):
        # one at a time: without it another one's law may be plain
        least = min((w for w in worths if w.name in vague), key=lambda w: min(w.share, 1.0) * w.size).name
        gone = [i for i, term in enumerate(solution.design.terms) if term.name == least]
        solution, held, worths = convicted(polished(fit(reduced(solution.design, gone)), runs, covered), p.court)
    case = Heard(p, solution, held, worths, _in_words(solution, runs, covariance))
    return _without_doubtful(case, runs, covered)


def _without_doubtful(case: Heard, runs: Sequence[int], covered: Reach) -> Heard:
    """Without names whose size may as well be zero, unless something is left to explain without them."""
    doubtful = [w for w in case.worths if (words := case.words.get(w.name)) and holds_zero(words[0])]
    if not doubtful:
        return case
    least = min(doubtful, key=lambda w: w.work).name
    s = case.solution
    gone = [i for i, term in enumerate(s.design.terms) if term.name == least]
    s, held, worths = convicted(polished(fit(reduced(s.design, gone)), runs, covered), case.p.court)
    other = Heard(case.p, s, held, worths, _in_words(s, runs, covariance))
    if other.loud or len(worths) < len(case.worths) - 1:
        return case
    return _without_doubtful(other, runs, covered)


def heard_again(case: Heard, found: Found, bank: Bank, runs: Sequence[int], covered: Reach) -> Heard:
    """Where much is left, those that nobody asked for want of room: all but the refused ones. What they say counts when
    it explains everything; else the first hearing stands."""
    stay = {term.name for term in case.solution.design.terms}
    refused = frozenset(name for name in found.names if name not in stay)
    if not refused or case.p.own.line is not None or not case.loud:
        return case
    d = case.solution.design
    others = search_some(d, bank, runs, covered, case.p.floors, ranking=found.ranking, refused=refused)
    if not set(others.names) - stay:
        return case
    other = heard(case.p, others, runs, covered)
    return other if _settles(other, stay) or _stands_alone(other, stay) else case


def heard_alone(case: Heard, found: Found, runs: Sequence[int], covered: Reach) -> Heard:
    """Where much is left: the loudest suspects, each alone beside what stands. Many small ones that the search put
    beside the true effect can drive it out. What one of them says counts when it explains everything."""
    if case.p.own.line is not None or not case.loud:
        return case
    stay = {term.name for term in case.solution.design.terms}
    for scored in [r for r in found.ranking[:ALONE_TRIED] if r.term.name not in stay]:
        s = settled(refine(case.solution.design, scored.term, runs, covered)[1], runs, covered)
        other = heard(case.p, replace(found, solution=s), runs, covered)
        more = stay < {term.name for term in other.solution.design.terms}
        if more and (_settles(other, stay) or _stands_alone(other, stay)):
            return other
    return case


def heard_in_turn(case: Heard, found: Found, runs: Sequence[int], covered: Reach) -> Heard:
    """Where much is left and something was refused: what the search found first, without what came later. A true effect
    whose law is a little off leaves a rest that late terms chase, and beside those it has not its size any more. What
    leaves least on unseen runs counts, where no name is lost by it."""
    terms = found.solution.design.terms
    stay = {term.name for term in case.solution.design.terms}
    if case.p.own.line is not None or not case.loud or not found.names or stay >= set(found.names):
        return case
    ends = [i for i in range(1, len(terms)) if terms[i].name != terms[i - 1].name][:TURNS]
    for end in ends:
        s = fit(reduced(found.solution.design, range(end, len(terms))))
        other = heard(case.p, replace(found, solution=s), runs, covered)
        if stay < {term.name for term in other.solution.design.terms} and _left(other) < _left(case):
            case, stay = other, {term.name for term in other.solution.design.terms}
    return case


def heard_instead(case: Heard, found: Found, runs: Sequence[int], covered: Reach) -> Heard:
    """Where the one effect that stands wants another size from run to run: look-alikes that explained nearly as much,
    each in its place. One that is steadier and leaves less of unseen runs is rather what it is."""
    names = {term.name for term in case.solution.design.terms}
    if len(names) != 1 or len(case.worths) != 1 or case.worths[0].fairly:
        return case
    mine = next((r.evidence for r in found.ranking if r.term.name in names), np.inf)
    alike = [r for r in found.ranking if r.term.name not in names and r.evidence > ALIKE * mine]
    for scored in alike[:ALONE_TRIED]:
        s = settled(refine(case.p.baseline.design, scored.term, runs, covered)[1], runs, covered)
        other = heard(case.p, replace(found, solution=s), runs, covered)
        if len(other.worths) == 1 and _steadier(other, case) and _in_all(other) < _in_all(case):
            case = other
    return case


def _steadier(one: Heard, other: Heard) -> bool:
    return max(one.worths[0].unsteady, one.worths[0].apart) < max(other.worths[0].unsteady, other.worths[0].apart)


def _in_all(case: Heard) -> float:
    """RMS over floor of all channels of unseen runs together."""
    left = case.p.court.residuals(case.solution, case.held)
    return case.p.court.ratio(left, list(left))


def _left(case: Heard) -> float:
    """RMS over floor of the worst channel on unseen runs."""
    return case.p.court.worst(case.p.court.residuals(case.solution, case.held))[0]


def _settles(other: Heard, stay: Collection[str]) -> bool:
    """Whether a second choice explains everything, and the numbers that scale its laws (a frequency, a torque) are
    known to a third of themselves: more is asked of it than that they are not zero."""
    return not other.loud and _known(other, stay)


def _known(other: Heard, stay: Collection[str]) -> bool:
    new = {term.name for term in other.solution.design.terms if term.name not in stay}
    known = [p for name in new for p in scales(other.solution, name, other.words)]
    return all(p.ci95[1] - p.ci95[0] < 2 * KNOWN * abs(p.value) for p in known)


def _stands_alone(other: Heard, stay: Collection[str]) -> bool:
    """Whether a second choice, where nothing had a name, explains nearly all of what it acts on with one size in all
    runs: it is named though something is left beside it."""
    plain = all(w.share > MOSTLY and w.fairly and w.left < MISSING for w in other.worths)
    return not stay and bool(other.worths) and plain and not cast(other.solution) and _known(other, stay)


def beyond_doubt(case: Heard) -> bool:
    """Whether what the search found where nothing is above the floor may be said all the same: floors are measured on
    few repeats, and can be too high. Every name must be large, of one size in all runs and what it acts on must be
    explained, and nothing unnamed be needed beside it."""
    plain = case.worths and not cast(case.solution) and not case.loud
    return bool(plain) and all(w.size > PLAIN_TO_SEE and w.fairly for w in case.worths)


def is_calm(p: Prepared) -> bool:
    """Whether the baseline is at the floor on the held-out runs."""
    most, one = p.court.worst(p.court.residuals(p.baseline, unseen(p.baseline, p.court)))
    return most < QUIET and one < MISSING


Convicted = tuple[Solution, Design, list[Worth]]
"""As `convicted` gives it."""


def _polished(p: Prepared, s: Solution, so_far: Convicted, runs: Sequence[int], covered: Reach) -> Convicted:
    """Laws fitted again beside those that stayed; as they were where that loses one: two terms of one effect can trade
    what single runs show, and foretell nonsense of others."""
    again = convicted(polished(s, runs, covered), p.court)
    kept = {term.name for term in again[0].design.terms}
    return again if kept >= {term.name for term in s.design.terms} else so_far


def _in_words(s: Solution, runs: Sequence[int], spread: Callable[[Solution], Array]) -> Words:
    return effects(s, runs, spread) if s.design.terms else {}


def _floored(p: Prepared, s: Solution, runs: Sequence[int]) -> Prepared:
    """With the floor measured beside the effects that stayed: refused ones may have taken noise with them.

    Where nothing was repeated one turn differs from the next by what the model lacks as well: they stay, unless
    nothing is left over that larger floor either.
    """
    measured = quieter(p.first, measure(s, runs)) if s.design.terms else p.first
    if any(term.effect.remembers for term in s.design.terms):
        measured = replace(measured, noise=measured.noise.free("A"))
    again = replace(p, measured=measured, court=court(p.eq, measured, p.split.held_out))
    known = repeats(p.eq.runs, runs) or not is_loud(again.court, s, unseen(s, again.court))
    return again if known else p


def is_loud(at: Court, s: Solution, held: Design) -> bool:
    """Whether more is left on the held-out runs than may be."""
    return at.loud(at.residuals(s, held), MISSING, bool(s.design.terms))


def _own_convicted(p: Prepared, s: Solution) -> tuple[Prepared, Solution]:
    """Without effects of each run's own that take too little of the held-out excess to be named."""
    failing = [name for name, (share, _) in own_work(p, s).items() if share < NAMED]
    if not failing:
        return p, s
    left = p.own.without(failing)
    again = replace(p, own=left, eq=replace(p.eq, own=left.columns()))
    eq = replace(s.design.eq, own=left.columns())
    again = replace(again, court=court(again.eq, again.measured, p.split.held_out))
    return again, fit(design(eq, s.design.terms, p.split.fitted))
