"""How much of a law without a name there is, for people: its verdict says what changes with what."""

from __future__ import annotations

from typing import Final

from rig.analysis.findings.collected import pm, true_minus
from rig.analysis.tracing.fit.covariance import covariance
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.parameters import of_term
from rig.analysis.tracing.nameless.law import Nameless

KNOWN: Final = 0.5  # of itself: with a wider interval the number says no more than the sentence


def amounts(s: Solution) -> list[str]:
    """A sentence for each such law in the model that one number tells, if it is known."""
    laws = [(i, term.effect) for i, term in enumerate(s.design.terms) if isinstance(term.effect, Nameless)]
    if not laws:
        return []
    c, said = covariance(s), []
    for i, law in laws:
        much = law.amount(of_term(s, c, i))
        if much is not None and much.half < KNOWN * abs(much.value):
            what = law.in_short[0].upper() + law.in_short[1:]
            said.append(true_minus(f"{what}: {much.says} {pm(much.value, much.half, much.unit)}."))
    return said
