"""Laws that a plainer one takes the place of, where that explains as much.

A ripple in proportion to the torque and cogging of the same order are nearly one wave where the torque's size hardly
changes, and beside the many columns of a search either may be taken for what is there: beside what stands in the end
it shows which it is. What follows a temperature that was logged has one number, where a curve over the time, which
bends as the drive warms, has two. And a drag with the square of the speed has one where a friction that falls over
some speed has three, which make the same curve of a handful of speeds.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, extended, fit
from rig.analysis.tracing.fit.search import as_fit, reduced
from rig.analysis.tracing.nameless.springs import SpringByWarmth, SpringDrift
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.model.effects import LIBRARY
from rig.model.effects.cogging_torque import CoggingTorque
from rig.model.effects.quadratic_drag import MOTOR, QuadraticDrag
from rig.model.effects.stribeck_friction import StribeckFriction
from rig.model.effects.torque_ripple import TorqueRipple

AS_MUCH: Final = 0.95  # of what the curve explains: the temperature was read with an error, the time was not
SQUARE: Final = (0.0, 2.0, MOTOR)  # of the speed, either way of turning, at the motor


def plainer(s: Solution, runs: Sequence[int]) -> Solution:
    """`s` with plainer laws in the place of those that explain no more; `s` itself where there are none."""
    for term in s.design.terms:
        if (found := _instead_of(term)) is None or found[0] in s.design.terms:
            continue
        other, share = found
        bare = reduced(s.design, [s.design.terms.index(term)])
        without, with_it = fit(bare).gain, fit(extended(bare, other, runs))
        if with_it.gain - without > share * (s.gain - without) and is_plausible(with_it):
            s = with_it
    return s


def is_plausible(s: Solution) -> bool:
    """Whether the last term may be what it says: a drag brakes, what is shared out is no more than all."""
    last = len(s.design.terms) - 1
    return s.design.terms[last].effect.plausible(as_fit(s, s.design.terms[last], s.x[s.design.place(last)]))


def _instead_of(term: Term) -> tuple[Term, float] | None:
    """What may take its place, and what of its gain it must have."""
    if term.name == TorqueRipple.name:
        return Term(LIBRARY[CoggingTorque.name], term.shape[:1]), 1.0
    if term.name == SpringDrift.name:
        return Term(CONFOUNDERS[SpringByWarmth.name].effect, ()), AS_MUCH
    if term.name == StribeckFriction.name:
        return Term(LIBRARY[QuadraticDrag.name], SQUARE), AS_MUCH
    return None
