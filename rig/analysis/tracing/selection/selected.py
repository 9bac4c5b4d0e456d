"""What of the search's effects is selected on the held-out runs, and whether what is found at the floor may be said."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rig.analysis.tracing.fit.covariance import covariance, scatter
from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.fit.leaning import carrying
from rig.analysis.tracing.fit.model import Design, Solution, design, fit
from rig.analysis.tracing.fit.parameters import effects
from rig.analysis.tracing.fit.search import Found, polished, reduced
from rig.analysis.tracing.floor.held_out import HeldOut, held_out_blocks, unseen
from rig.analysis.tracing.floor.noise import Measured, measure, quieter
from rig.analysis.tracing.floor.of_a_run import PAIRS
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.rest.levels import friction_by_speed
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.selection.confounders import CONFOUNDERS, confounders_in, with_confounders
from rig.analysis.tracing.selection.elimination import (
    backward_elimination,
    run_to_the_end,
    scales,
    unresolved,
    unscaled,
)
from rig.analysis.tracing.selection.instead_of import at_a_vibration, instead_of_the_gear
from rig.analysis.tracing.selection.own_scores import own_scores
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.sizes import may_be_nothing
from rig.analysis.tracing.thresholds import (
    ALL,
    AS_WELL,
    AT_THE_FLOOR,
    EXPLAINED,
    FREED,
    KNOWN,
    MISSING,
    NAMED,
    PLAIN_TO_SEE,
    QUIET,
    SEEN,
    UNKNOWN,
    VOUCHED_FOR,
    WORSE,
)
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter, Reach

Words = dict[str, tuple[Parameter, ...]]
"""Parameters by effect."""


@dataclass(frozen=True)
class Selected:
    """The model with the effects that may be named, on the held-out runs, and their parameters in words."""

    p: Prepared
    solution: Solution
    held: Design
    scores: list[HeldOutScore]
    words: Words

    @property
    def names(self) -> set[str]:
        """Effects that stand."""
        return {term.name for term in self.solution.design.terms}

    @property
    def taken(self) -> frozenset[str]:
        """Names that are not looked for beside what is there: those of effects that every run has to itself."""
        return frozenset(self.p.own.made)

    @property
    def fitted_runs(self) -> list[Recording]:
        """Those the fit has seen."""
        return [self.p.eq.runs[i] for i in self.p.split.fitted]

    @property
    def left(self) -> float:
        """RMS over floor of the worst channel on unseen runs."""
        return _left(self.p, (self.solution, self.held, self.scores))

    @cached_property
    def loud(self) -> bool:
        """Whether more is left on the held-out runs than may be, or the same in all runs at one speed."""
        return is_loud(self.p.held_out, self.solution, self.held) or _by_speed(self.p, self.solution, self.held)


def select(p: Prepared, found: Found, runs: Sequence[int], covered: Reach) -> Selected:
    """Effects are eliminated until all that are left may be named; their laws are fitted again beside each other."""
    solution, held, scores = backward_elimination(found.solution, p.held_out)
    if len(solution.design.terms) < len(found.solution.design.terms):
        p = _floored(p, solution, runs)
        solution, held, scores = backward_elimination(solution, p.held_out)
    fewer = len(solution.design.terms) < len(found.solution.design.terms)
    if fewer or found.rough or len(solution.design.terms) > 1:
        solution, held, scores = _polished(p, solution, (solution, held, scores), runs, covered)
    p, solution = _own_kept(p, solution)
    solution, held, scores = _stood_in_for(p, (solution, held, scores), runs, covered)
    told = solution.design.terms
    while vague := _not_told(p, solution, held, runs, covered):
        # one at a time: without it another one's law may be plain
        candidates = [score for score in scores if score.name in vague]
        least = min(candidates, key=lambda score: min(score.share, 1.0) * score.size).name
        gone = [i for i, term in enumerate(solution.design.terms) if term.name == least]
        solution, held, scores = backward_elimination(
            polished(fit(reduced(solution.design, gone)), runs, covered), p.held_out
        )
    if len(solution.design.terms) < len(told):
        p = _floored(p, solution, runs)
        solution, held, scores = backward_elimination(solution, p.held_out)
    if not solution.design.terms and solution.design.eq is not p.eq:
        # what eliminated effects made of the gear, and with it of readings it stands in for, goes with them
        solution = fit(design(carrying(p.eq, ()), (), runs))
        held = unseen(solution, p.held_out)
    selected = Selected(p, solution, held, scores, _in_words(solution, runs, covariance))
    selected = _without_needless(_without_insignificant(selected, runs, covered), runs, covered)
    return _without_idle(selected, runs, covered)


def _not_told(p: Prepared, s: Solution, held: Design, runs: Sequence[int], covered: Reach) -> list[str]:
    """Effects of whose law, or of which beside the spring, the data say nothing; beside an unknown rest those too that
    a law at the end of its range was needed for."""
    words = _in_words(s, runs, scatter)
    vague = unresolved(s, words, covered) or instead_of_the_gear(s) or at_a_vibration(p.own, words)
    ended = run_to_the_end(s, covered)
    return vague or (ended if ended and is_loud(p.held_out, s, held) else [])


def _without_insignificant(selected: Selected, runs: Sequence[int], covered: Reach) -> Selected:
    """Without names whose size may as well be zero, or is hardly known beside a name that does more, or whose law may
    be any beside an unknown rest, unless something is left to explain that is not with them: where few repeats tell
    the floor, that is no reason for such a name. Of two that stand in for each other either may be the one that can go:
    the one that does less is tried first."""
    effect = {term.name: term.effect for term in selected.solution.design.terms}
    most = max((score.overall for score in selected.scores), default=0.0) if not selected.p.own.made else np.inf
    vague = unscaled(selected.solution, selected.words) if selected.scores and selected.loud else []
    insignificant = [
        score
        for score in selected.scores
        if (sizes := effect[score.name].sizes(selected.words.get(score.name, ())))
        and (
            score.name in vague
            or may_be_nothing(effect[score.name], selected.words.get(score.name, ()))
            or (score.overall < most and not _vouched_for(score, most) and all(_is_hardly_known(p) for p in sizes))
        )
    ]
    needless = {score.name for score in insignificant}
    nothing = {name for name in needless if may_be_nothing(effect[name], selected.words.get(name, ()))}
    few = _few_repeats(selected.p, runs)
    for least in sorted(insignificant, key=lambda score: score.overall):
        fewer = _without(selected, least.name, runs, covered)
        gone = selected.names - fewer.names  # with one that leans on it, if that is not known either
        no_name = few and gone.isdisjoint(CONFOUNDERS)
        empty = gone <= nothing and _says_nothing(selected, gone)
        if gone <= needless and (no_name or selected.loud or not fewer.loud or empty):
            return _without_insignificant(fewer, runs, covered)
    return selected


def _says_nothing(selected: Selected, names: set[str]) -> bool:
    """Whether there are any, and of the law of none of them is anything known, not to ten times itself: what is left
    without such a name is not explained by it either."""
    laws = [scales(selected.solution, name, selected.words) for name in names]
    return bool(laws) and all(law and all(_is_unknown(scale) for scale in law) for law in laws)


def _is_unknown(scale: Parameter) -> bool:
    return scale.ci95[1] - scale.ci95[0] > 2 * UNKNOWN * abs(scale.value)


def _few_repeats(p: Prepared, runs: Sequence[int]) -> bool:
    return len(repeats(p.eq.runs, runs)) < PAIRS


def _vouched_for(score: HeldOutScore, most: float) -> bool:
    """Whether runs want one size of it, and repeats no other one: beside other effects, not beside lost counts, which
    are another size in every run."""
    return score.as_repeats and score.fairly and bool(np.isfinite(most))


def _is_hardly_known(size: Parameter) -> bool:
    """Whether a size is known worse than to a third of itself: of 21 right names that stood beside one that did more
    the worst was known to a seventh, the wrong one (exam 30, case 40) to nine tenths."""
    return size.ci95[1] - size.ci95[0] > 2 * KNOWN * abs(size.value)


def _without_needless(selected: Selected, runs: Sequence[int], covered: Reach) -> Selected:
    """Of a load whose torque nobody read, without names that leave no more behind when they go, or nothing above the
    floor: what came in beside a spring and an inertia as they were believed to be may be needed no more beside those
    that are."""
    if not any(run.load_unread and (run.look.inertia or run.carries) for run in selected.fitted_runs):
        return selected
    for least in sorted(selected.scores, key=lambda score: score.size):
        fewer = _without(selected, least.name, runs, covered)
        as_well = max(AS_WELL * selected.left, AT_THE_FLOOR)
        if len(fewer.scores) == len(selected.scores) - 1 and fewer.left < as_well:
            return _without_needless(fewer, runs, covered)
    return selected


def _without_idle(selected: Selected, runs: Sequence[int], covered: Reach) -> Selected:
    """Without further terms of an effect that may as well be nothing: what the search put beside the first one of them
    while that was not yet what it is now."""
    terms = selected.solution.design.terms
    several = [i for i, term in enumerate(terms) if sum(term.name == other.name for other in terms) > 1]
    if not several:
        return selected
    known = covariance(selected.solution)
    least = min(several, key=lambda i: _told(selected.solution, known, i))
    if _told(selected.solution, known, least) > Z95**2:
        return selected
    s = polished(fit(reduced(selected.solution.design, [least])), runs, covered)
    kept = backward_elimination(s, selected.p.held_out)
    fewer = Selected(selected.p, *kept, _in_words(kept[0], runs, covariance))
    as_well = fewer.left <= AS_WELL * selected.left and (selected.loud or not fewer.loud)
    return _without_idle(fewer, runs, covered) if as_well and fewer.names == selected.names else selected


def _told(s: Solution, known: Array, term: int) -> float:
    """Squares of the coefficients of a term over what is known of them (p, p), a coefficient."""
    at = s.design.place(term)
    x = s.x[at]
    return float(x @ np.linalg.pinv(known[at, at]) @ x) / max(x.size, 1)


def _without(selected: Selected, name: str, runs: Sequence[int], covered: Reach) -> Selected:
    s = selected.solution
    gone = [i for i, term in enumerate(s.design.terms) if term.name == name]
    s, held, scores = backward_elimination(polished(fit(reduced(s.design, gone)), runs, covered), selected.p.held_out)
    return Selected(selected.p, s, held, scores, _in_words(s, runs, covariance))


def is_certain(selected: Selected, floors: HeldOut) -> bool:
    """Whether what the search found where nothing is above the `floors` may be said all the same: they are measured on
    few repeats, and can be too high. Every name must be large and its size known, or repeats vouch for it, of one size
    in all runs and what it acts on must be explained, and nothing unnamed be needed beside it, by those floors: by the
    ones that are measured beside it small effects of others may stand out."""
    loud = all(is_loud(at, selected.solution, selected.held) for at in (selected.p.held_out, floors))
    plain = selected.scores and not confounders_in(selected.solution) and not loud
    return bool(plain) and all(_is_plain_to_see(selected, score) for score in selected.scores)


def _is_plain_to_see(selected: Selected, score: HeldOutScore) -> bool:
    """Large, and of a size that is known, or foretold of unseen runs where its law is: two runs at one speed may be all
    that show a resonance, and from two no interval comes out narrow."""
    effect = next(term.effect for term in selected.solution.design.terms if term.name == score.name)
    law = scales(selected.solution, score.name, selected.words)
    foretold = score.share > ALL and bool(law) and not any(_is_hardly_known(scale) for scale in law)
    known = foretold or not all(_is_hardly_known(size) for size in effect.sizes(selected.words.get(score.name, ())))
    vouched = score.as_repeats and (score.size > VOUCHED_FOR or score.seen > SEEN)
    return score.fairly and ((known and score.size > PLAIN_TO_SEE) or vouched)


def is_calm(p: Prepared) -> bool:
    """Whether the baseline is at the floor on the held-out runs, and no speed has a friction of its own."""
    held = unseen(p.baseline, p.held_out)
    most, one = p.held_out.beyond_chance(p.held_out.residuals(p.baseline, held))
    return most < QUIET and one < MISSING and not _by_speed(p, p.baseline, held)


def _by_speed(p: Prepared, s: Solution, held: Design) -> bool:
    left = {key: s.residual(key) for key in s.keys} | p.held_out.residuals(s, held)
    return friction_by_speed(p.eq, left, {**p.floors, **p.held_out.floors}) is not None


Kept = tuple[Solution, Design, list[HeldOutScore]]
"""As `backward_elimination` gives it."""


def _polished(p: Prepared, s: Solution, so_far: Kept, runs: Sequence[int], covered: Reach) -> Kept:
    """Laws fitted again beside those that stayed; as they were where that loses one, or leaves much more of unseen
    runs: two terms of one effect can trade what single runs show, and foretell nonsense of others."""
    again = backward_elimination(polished(s, runs, covered), p.held_out)
    kept = {term.name for term in again[0].design.terms}
    now, before = (_left(p, one) for one in (again, so_far))
    worse = now > max(WORSE * before, EXPLAINED)
    return again if kept >= {term.name for term in s.design.terms} and not worse else so_far


def _left(p: Prepared, kept: Kept) -> float:
    """RMS over floor of the worst channel on unseen runs."""
    return p.held_out.worst(p.held_out.residuals(kept[0], kept[1]))[0]


def _stood_in_for(p: Prepared, kept: Kept, runs: Sequence[int], covered: Reach) -> Kept:
    """With the confounders that explain more than what they are taken for. What leaves more of unseen runs takes no
    name away: fitted ones may tell two loops apart by what either law has wrong (exam 34, case 25). Where one may fall
    short of its look-alike and does by no more, and that one leaves much itself, either may be what there is: no name
    then (exam 56, case 42)."""
    s, other = kept[0], with_confounders(kept[0], runs, covered)
    again = backward_elimination(other, p.held_out)
    came = {term.name for term in other.design.terms} - {term.name for term in s.design.terms}
    if not came:
        return again
    as_it_was = backward_elimination(s, p.held_out)
    if came.isdisjoint(term.name for term in again[0].design.terms):
        return as_it_was
    freed = any(name in came and law.zero_of for name, law in CONFOUNDERS.items())
    if _left(p, again) * (FREED if freed else 1.0) < _left(p, as_it_was):
        return again
    short = [law for name, law in CONFOUNDERS.items() if name in came and law.short]
    mimicked = frozenset().union(*(law.mimics for law in short))
    amiss = any(score.name in mimicked and score.left > MISSING for score in as_it_was[2])
    return again if amiss and len(short) == len(came) else as_it_was


def _in_words(s: Solution, runs: Sequence[int], spread: Callable[[Solution], Array]) -> Words:
    return effects(s, runs, spread) if s.design.terms else {}


def _floored(p: Prepared, s: Solution, runs: Sequence[int]) -> Prepared:
    """With the floor measured beside the effects that stayed: eliminated ones may have taken noise with them.

    Where nothing was repeated one turn differs from the next by what the model lacks as well: they stay, unless
    nothing is left over that larger floor either.
    """
    measured = quieter(p.first, measure(s, runs)) if s.design.terms else p.first
    if any(term.effect.remembers for term in s.design.terms):
        measured = replace(measured, noise=measured.noise.free("A"))
    again = replace(p, measured=measured, held_out=_held_out(p, p.eq, measured))
    known = repeats(p.eq.runs, runs) or not is_loud(again.held_out, s, unseen(s, again.held_out))
    return again if known else p


def _held_out(p: Prepared, eq: Equations, measured: Measured) -> HeldOut:
    """Those blocks anew, of a campaign that is as calm as it was."""
    return replace(held_out_blocks(eq, measured, p.split.held_out), calm=p.held_out.calm)


def is_loud(at: HeldOut, s: Solution, held: Design) -> bool:
    """Whether more is left on the held-out runs than may be."""
    return at.loud(at.residuals(s, held), MISSING, bool(s.design.terms))


def _own_kept(p: Prepared, s: Solution) -> tuple[Prepared, Solution]:
    """Without effects of each run's own that take too little of the held-out excess to be named."""
    failing = [name for name, (share, _) in own_scores(p, s).items() if share < NAMED]
    if not failing:
        return p, s
    left = p.own.without(failing)
    again = replace(p, own=left, eq=replace(p.eq, own=left.columns()))
    eq = replace(s.design.eq, own=left.columns())
    again = replace(again, held_out=_held_out(p, again.eq, again.measured))
    return again, fit(design(eq, s.design.terms, p.split.fitted))
