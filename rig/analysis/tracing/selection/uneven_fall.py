"""A kinematic error that shrinks by another share under positive torque than under negative, in the place of one that
shrinks alike and a spring that changes with the angle.

What stays of the series on one side more than on the other is a wave that has the sign of the torque, and so has the
wind-up of such a spring. But the spring goes on winding up where the kinematic error shrinks no more, and has orders
and phases of its own: of the campaign with it (exam 85, case 12) one number said more than its eight, by 466 nats.
"""

from __future__ import annotations

from collections.abc import Sequence

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import reduced
from rig.analysis.tracing.selection.plainer import is_plausible
from rig.model.effect import Reach
from rig.model.effects import LIBRARY
from rig.model.effects.angle_dependent_stiffness import AngleDependentStiffness
from rig.model.effects.load_dependent_kinematic_error import LoadDependentKinematicError


def uneven_fall(s: Solution, runs: Sequence[int], covered: Reach) -> Solution:
    """`s` with what is left of the kinematic error uneven in the place of such a spring, where that fits better; else
    `s` itself."""
    terms = s.design.terms
    springs = [i for i, term in enumerate(terms) if term.name == AngleDependentStiffness.name]
    if not springs or all(term.name != LoadDependentKinematicError.name for term in terms):
        return s
    bare, effect = reduced(s.design, springs), LIBRARY[LoadDependentKinematicError.name]
    tried = [refine(bare, Term(effect, shape), runs, covered)[1] for shape in effect.shapes_beside(covered)]
    best = max(tried, key=lambda one: one.gain, default=s)
    return best if best.gain > s.gain and is_plausible(best) else s
