"""Names that go again: their size may as well be zero, or without them no more is left."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.covariance import covariance
from rig.analysis.tracing.fit.model import Solution, fit
from rig.analysis.tracing.fit.search import polished, reduced
from rig.analysis.tracing.floor.of_a_run import PAIRS
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.runs.holdout import HELD_PART
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.selection.elimination import backward_elimination, scales, unscaled
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.selected import Selected, in_words
from rig.analysis.tracing.selection.sizes import is_hardly_known, is_known_to, may_be_nothing
from rig.analysis.tracing.thresholds import AS_WELL, AT_THE_FLOOR, MOSTLY, QUIET, UNKNOWN
from rig.core.quantiles import Z95
from rig.model.effect import Array, Reach

# times a size: a friction at rest that no run was slow enough for is known to 1.1 (exam 67, 42), a loop that stood in
# for creep was to forty
ROUGHLY: Final = 2.0
TOGETHER: Final = 5.0  # standard errors a coefficient, RMS: of a drive that heats itself, on the paper's runs, 8 and 19


def without_insignificant(selected: Selected, runs: Sequence[int], covered: Reach) -> Selected:
    """Without names whose size may be zero, or is hardly known while another name does more, or whose law may be any
    while an unexplained residual stands beside it. Such a name stays where something would be left unexplained without
    it, but not on the word of a floor that few repeats tell, and not for the sake of a single run where it may be
    nothing beside others. Of two that stand in for each other the one that does less is tried first."""
    effect = {term.name: term.effect for term in selected.solution.design.terms}
    theirs = {key for columns in selected.p.own.made.values() for key in columns}  # where what is a run's own stands
    largest = max((score.overall for score in selected.scores), default=0.0)
    most = {x.name: np.inf if theirs & {*x.ground} else largest for x in selected.scores}
    vague = _vague(selected) if selected.scores and selected.loud else set()
    insignificant = [
        score
        for score in selected.scores
        if (sizes := effect[score.name].sizes(selected.words.get(score.name, ())))
        and (
            score.name in vague
            or may_be_nothing(effect[score.name], selected.words.get(score.name, ()))
            or (
                score.overall < most[score.name]
                and not _is_sure(score, most[score.name])
                and all(is_hardly_known(p) for p in sizes)
            )
        )
    ]
    needless = {score.name for score in insignificant}
    nothing = {name for name in needless if may_be_nothing(effect[name], selected.words.get(name, ()))}
    few = _few_repeats(selected.p, runs)
    plain = {score.name for score in selected.scores if score.all_there_is and _is_something(selected, score.name)}
    plain |= {score.name for score in selected.scores if score.is_foretold and _of_other_runs(selected, score)}
    for least in sorted(insignificant, key=lambda score: score.overall):
        fewer = _without(selected, least.name, runs, covered)
        gone = selected.names - fewer.names  # with one that leans on it, if that is not known either
        no_name = few and gone.isdisjoint(CONFOUNDERS)
        empty = gone <= nothing and (_says_nothing(selected, gone) or (selected.names > gone and fewer.left < QUIET))
        if gone <= plain and fewer.loud:
            continue  # of a fall its size at rest, where no run was, may be any: that there is one is plain
        if gone <= needless and (no_name or selected.loud or not fewer.loud or empty):
            return without_insignificant(fewer, runs, covered)
    return selected


def _of_other_runs(selected: Selected, score: HeldOutScore) -> bool:
    """Whether the held-out runs in which it shows are whole ones, of which the fit has seen no part."""
    return all(HELD_PART not in selected.p.eq.runs[i].name for i, _ in score.ground)


def _is_something(selected: Selected, name: str) -> bool:
    """Whether the figures an effect's size is told with are known to ROUGHLY times themselves, or all its coefficients
    together are far from zero: how a drive that warms shares what it loses between what is constant and what goes with
    the speed, or between two laws of it, may be open where a few runs show that it does."""
    s = selected.solution
    mine = [i for i, term in enumerate(s.design.terms) if term.name == name]
    sizes = s.design.terms[mine[0]].effect.sizes(selected.words.get(name, ()))
    return all(is_known_to(ROUGHLY, size) for size in sizes) or _told(s, covariance(s), mine) > TOGETHER**2


def _vague(selected: Selected) -> set[str]:
    """Names of a law that may be any, and they a part of an unknown rest."""
    return set(unscaled(selected.solution, selected.words)) - {x.name for x in selected.scores if x.all_there_is}


def _says_nothing(selected: Selected, names: set[str]) -> bool:
    """Whether there are any, and of the law of none of them is anything known, not to ten times itself: what is left
    without such a name is not explained by it either."""
    laws = [scales(selected.solution, name, selected.words) for name in names]
    return bool(laws) and all(law and not any(is_known_to(UNKNOWN, scale) for scale in law) for law in laws)


def _few_repeats(p: Prepared, runs: Sequence[int]) -> bool:
    return len(repeats(p.eq.runs, runs)) < PAIRS


def _is_sure(score: HeldOutScore, most: float) -> bool:
    """Whether runs want one size of it, and repeats no other one; or it takes nearly all there is where it acts,
    plainly: the size that is told of a drag is that at 10 rad/s, and hardly known of one with the cube of the speed.
    Beside other effects, not beside lost counts, which are another size in every run."""
    vouched = score.as_repeats and score.fairly
    return bool(np.isfinite(most)) and (vouched or (score.plain and score.share > MOSTLY))


def without_needless(selected: Selected, runs: Sequence[int], covered: Reach) -> Selected:
    """Of a load whose torque nobody read, without names that leave no more behind when they go, or nothing above the
    floor: what came in beside a spring and an inertia as they were believed to be may be needed no more beside those
    that are."""
    if not any(run.load_unread and (run.look.inertia or run.carries) for run in selected.fitted_runs):
        return selected
    for least in sorted(selected.scores, key=lambda score: score.size):
        fewer = _without(selected, least.name, runs, covered)
        as_well = max(AS_WELL * selected.left, AT_THE_FLOOR)
        if len(fewer.scores) == len(selected.scores) - 1 and fewer.left < as_well:
            return without_needless(fewer, runs, covered)
    return selected


def without_idle(selected: Selected, runs: Sequence[int], covered: Reach) -> Selected:
    """Without further terms of an effect that may as well be nothing: what the search put beside the first one of them
    while that was not yet what it is now."""
    terms = selected.solution.design.terms
    several = [i for i, term in enumerate(terms) if sum(term.name == other.name for other in terms) > 1]
    if not several:
        return selected
    known = covariance(selected.solution)
    least = min(several, key=lambda i: _told(selected.solution, known, [i]))
    if _told(selected.solution, known, [least]) > Z95**2:
        return selected
    s = polished(fit(reduced(selected.solution.design, [least])), runs, covered)
    kept = backward_elimination(s, selected.p.held_out)
    fewer = Selected(selected.p, *kept, in_words(kept[0], runs, covariance))
    as_well = fewer.left <= AS_WELL * selected.left and (selected.loud or not fewer.loud)
    return without_idle(fewer, runs, covered) if as_well and fewer.names == selected.names else selected


def _told(s: Solution, known: Array, terms: Sequence[int]) -> float:
    """Squares of the coefficients of some terms over what is known of them (p, p), a coefficient."""
    at = np.concatenate([np.arange(s.x.size)[s.design.place(term)] for term in terms])
    x: Array = s.x[at]
    return float(x @ np.linalg.pinv(known[np.ix_(at, at)]) @ x) / max(x.size, 1)


def _without(selected: Selected, name: str, runs: Sequence[int], covered: Reach) -> Selected:
    s = selected.solution
    gone = [i for i, term in enumerate(s.design.terms) if term.name == name]
    s, held, scores = backward_elimination(polished(fit(reduced(s.design, gone)), runs, covered), selected.p.held_out)
    return Selected(selected.p, s, held, scores, in_words(s, runs, covariance))
