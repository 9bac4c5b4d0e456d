"""Laws that a plainer one takes the place of, where that explains as much.

A ripple in proportion to the torque and cogging of the same order are nearly one wave where the torque's size hardly
changes, and beside the many columns of a search either may be taken for what is there: beside what stands in the end
it shows which it is. And what follows a temperature that was logged has one number, where a curve over the time, which
bends as the drive warms, has two.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, extended, fit
from rig.analysis.tracing.fit.search import reduced
from rig.analysis.tracing.nameless.springs import SpringByWarmth, SpringDrift
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.model.effects import LIBRARY
from rig.model.effects.cogging_torque import CoggingTorque
from rig.model.effects.torque_ripple import TorqueRipple

AS_MUCH: Final = 0.95  # of what the curve explains: the temperature was read with an error, the time was not


def plainer(s: Solution, runs: Sequence[int]) -> Solution:
    """`s` with plainer laws in the place of those that explain no more; `s` itself where there are none."""
    for term in s.design.terms:
        if (found := _instead_of(term)) is None or found[0] in s.design.terms:
            continue
        other, share = found
        bare = reduced(s.design, [s.design.terms.index(term)])
        without, with_it = fit(bare).gain, fit(extended(bare, other, runs))
        s = with_it if with_it.gain - without > share * (s.gain - without) else s
    return s


def _instead_of(term: Term) -> tuple[Term, float] | None:
    """What may take its place, and what of its gain it must have."""
    if term.name == TorqueRipple.name:
        return Term(LIBRARY[CoggingTorque.name], term.shape[:1]), 1.0
    if term.name == SpringDrift.name:
        return Term(CONFOUNDERS[SpringByWarmth.name].effect, ()), AS_MUCH
    return None
