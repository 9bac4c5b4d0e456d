"""How much of a law without a name there is, for people: its verdict says what changes with what."""

from __future__ import annotations

from rig.analysis.findings.collected import pm, true_minus
from rig.analysis.tracing.fit.covariance import covariance
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.parameters import of_term
from rig.analysis.tracing.nameless.law import Nameless
from rig.analysis.tracing.thresholds import KNOWN


def laws_in(s: Solution) -> tuple[str, ...]:
    """A sentence for each such law in the model, with its size where one number tells that and is known."""
    laws = [(i, term.effect) for i, term in enumerate(s.design.terms) if isinstance(term.effect, Nameless)]
    if not laws:
        return ()
    c, said = covariance(s), []
    for i, law in laws:
        much = law.amount(of_term(s, c, i))
        what = law.in_short[0].upper() + law.in_short[1:]
        known = much is not None and much.half < KNOWN * abs(much.value)
        size = f": {much.says} {pm(much.value, much.half, much.unit)}" if much is not None and known else ""
        said.append(true_minus(f"{what}{size}."))
    return tuple(said)
