"""A ripple in proportion to the torque that cogging of the same order explains more than: it is cogging.

Where the torque's size hardly changes the two are nearly one wave, and beside the many columns of a search either may
be taken for what is there; beside what stands in the end it shows which it is.
"""

from __future__ import annotations

from collections.abc import Sequence

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, extended, fit
from rig.analysis.tracing.fit.search import reduced
from rig.model.effects import LIBRARY
from rig.model.effects.cogging_torque import CoggingTorque
from rig.model.effects.torque_ripple import TorqueRipple


def as_cogging(s: Solution, runs: Sequence[int]) -> Solution:
    """`s` with cogging in the place of every ripple that explains less than it; `s` itself where none does."""
    for ripple in [term for term in s.design.terms if term.name == TorqueRipple.name]:
        cogging = Term(LIBRARY[CoggingTorque.name], ripple.shape[:1])
        bare = reduced(s.design, [s.design.terms.index(ripple)])
        if cogging in bare.terms:
            continue
        other = fit(extended(bare, cogging, runs))
        s = other if other.gain > s.gain else s
    return s
