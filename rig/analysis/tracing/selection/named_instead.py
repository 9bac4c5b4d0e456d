"""A name of the library in the place of a law without one, where it does as well.

A search that adds small terms beside a true effect can drive that out in the end: a loop in the spring, for six lags of
a creep and a channel that is late. What has a name, needs less beside it and foretells unseen runs no worse is it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.bank import Bank
from rig.analysis.tracing.fit.model import Solution, fit
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, reduced, settled
from rig.analysis.tracing.fit.some import ranking_of_some
from rig.analysis.tracing.floor.held_out import HeldOut, unseen
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.selection.select import select
from rig.analysis.tracing.selection.selected import Selected
from rig.analysis.tracing.thresholds import LAWS, TRIED
from rig.model.effect import Reach

NO_WORSE: Final = 1.02  # of what is left of unseen runs, RMS over all channels


def named_instead(selected: Selected, found: Found, bank: Bank, runs: Sequence[int], covered: Reach) -> Selected:
    """Every law without a name that the search brought, against what has most evidence in its place and in that of all
    that came after it."""
    for law in sorted(selected.names & CONFOUNDERS.keys() & set(found.names)):
        before = set(found.names[: found.names.index(law)])
        terms = selected.solution.design.terms
        bare = fit(reduced(selected.solution.design, [i for i, term in enumerate(terms) if term.name not in before]))
        ranking = ranking_of_some(bare.design, bank, runs, covered, LAWS)
        but = before | selected.taken | CONFOUNDERS.keys()
        for rival in [r.term for r in ranking if r.term.name not in but][:TRIED]:
            s = settled(refine(bare.design, rival, runs, covered)[1], runs, covered)
            other = select(selected.p, replace(found, solution=s), runs, covered)
            needs_less = law not in other.names and rival.name in other.names and _needs_less(other, selected)
            if needs_less and _explains_as_much(other, selected, bare, CONFOUNDERS[law].short):
                return other
    return selected


def _needs_less(other: Selected, selected: Selected) -> bool:
    """Whether it has no more names and coefficients, and no other law without a name."""
    few = len(other.names) <= len(selected.names) and other.solution.design.size <= selected.solution.design.size
    return few and other.names & CONFOUNDERS.keys() <= selected.names


def _explains_as_much(other: Selected, selected: Selected, bare: Solution, short: float) -> bool:
    """Whether it explains everything, of fitted runs as much but for the share that a name may fall `short` by, and
    unseen ones as well."""
    at, s = selected.p.held_out, selected.solution
    rows = sum(y.size / s.design.eq.noise.kappa[channel] for (_, channel), y in s.design.y.items())
    saved = (s.design.size - other.solution.design.size) * float(np.log(rows)) + short * (s.gain - bare.gain)
    as_much = other.solution.gain + saved > s.gain
    return as_much and not other.loud and _left(other, at) <= NO_WORSE * _left(selected, at)


def _left(selected: Selected, at: HeldOut) -> float:
    """RMS over the same floors of all channels of unseen runs together."""
    left = at.residuals(selected.solution, unseen(selected.solution, at))
    return at.ratio(left, list(left))
