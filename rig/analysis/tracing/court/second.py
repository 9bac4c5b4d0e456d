"""Second hearings, where the first explained little or left a doubt.

The search takes the best suspect first. A look-alike that comes before the true effect is refused on unseen runs, and
the true one was never asked; late terms that chase a rest take a true one's size with them.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from rig.analysis.tracing.court.hearing import Heard, heard
from rig.analysis.tracing.court.judge import scales
from rig.analysis.tracing.court.shadows import cast
from rig.analysis.tracing.fit.bank import Bank
from rig.analysis.tracing.fit.model import fit
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, reduced, settled
from rig.analysis.tracing.fit.some import search_some
from rig.analysis.tracing.thresholds import ALIKE, KNOWN, MISSING, MOSTLY, TRIED, TURNS
from rig.model.effect import Reach


def heard_further(case: Heard, found: Found, bank: Bank, runs: Sequence[int], covered: Reach) -> Heard:
    """All of them, one after the other: each has its own reason to be held, and most cases none."""
    case = heard_in_turn(case, found, runs, covered)
    case = heard_again(case, found, bank, runs, covered)
    case = heard_alone(case, found, runs, covered)
    return heard_instead(case, found, runs, covered)


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
    for scored in [r for r in found.ranking[:TRIED] if r.term.name not in stay]:
        s = settled(refine(case.solution.design, scored.term, runs, covered)[1], runs, covered)
        other = heard(case.p, replace(found, solution=s), runs, covered)
        more = stay < {term.name for term in other.solution.design.terms}
        if more and (_settles(other, stay) or _stands_alone(other, stay)):
            return other
    return case


def heard_instead(case: Heard, found: Found, runs: Sequence[int], covered: Reach) -> Heard:
    """Where the one effect that stands wants another size from run to run: look-alikes that explained nearly as much,
    each in its place. One that is steadier and leaves less of unseen runs is rather what it is."""
    names = {term.name for term in case.solution.design.terms}
    if len(names) != 1 or len(case.worths) != 1 or case.worths[0].fairly:
        return case
    mine = next((r.evidence for r in found.ranking if r.term.name in names), np.inf)
    alike = [r for r in found.ranking if r.term.name not in names and r.evidence > ALIKE * mine]
    for scored in alike[:TRIED]:
        s = settled(refine(case.p.baseline.design, scored.term, runs, covered)[1], runs, covered)
        other = heard(case.p, replace(found, solution=s), runs, covered)
        if len(other.worths) == 1 and _steadier(other, case) and _in_all(other) < _in_all(case):
            case = other
    return case


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


def _steadier(one: Heard, other: Heard) -> bool:
    return max(one.worths[0].unsteady, one.worths[0].apart) < max(other.worths[0].unsteady, other.worths[0].apart)


def _in_all(case: Heard) -> float:
    """RMS over floor of all channels of unseen runs together."""
    left = case.p.court.residuals(case.solution, case.held)
    return case.p.court.ratio(left, list(left))


def _left(case: Heard) -> float:
    """RMS over floor of the worst channel on unseen runs."""
    return case.p.court.worst(case.p.court.residuals(case.solution, case.held))[0]
