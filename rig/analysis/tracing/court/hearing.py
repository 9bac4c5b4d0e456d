"""What the search brought, before the court: which effects stay, and whether what is found at the floor may be said."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rig.analysis.tracing.court.judge import (
    Court,
    Worth,
    convicted,
    court,
    unresolved,
    unseen,
)
from rig.analysis.tracing.court.own_work import own_work
from rig.analysis.tracing.court.shadows import cast, unmasked
from rig.analysis.tracing.fit.covariance import covariance, scatter
from rig.analysis.tracing.fit.model import Design, Solution, design, fit
from rig.analysis.tracing.fit.parameters import effects
from rig.analysis.tracing.fit.search import Found, polished, reduced
from rig.analysis.tracing.floor.noise import measure, quieter
from rig.analysis.tracing.floor.repeats import repeats
from rig.analysis.tracing.thresholds import MISSING, NAMED, PLAIN_TO_SEE, QUIET
from rig.model.effect import Array, Parameter, Reach

if TYPE_CHECKING:
    from rig.analysis.tracing.trace import Prepared


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
    doubtful = [w for w in case.worths if (words := case.words.get(w.name)) and words[0].holds_zero]
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
