"""Two plain laws in the place of a bent one: a friction that falls near rest and a drag that grows at speed are drawn
by one law that goes on falling for long, well enough to leave little over the floor.

Each of the two is then as large as what was found, and fits the runs better by far. Of eight campaigns with one of them
alone the pair was no better than by 114 nats, with a drag that was known to no half of itself; of the one with both
(exam 83, case 37), by 1404, with one known to a fiftieth.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, extended
from rig.analysis.tracing.fit.parameters import effects
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import reduced
from rig.analysis.tracing.selection.plainer import SQUARE
from rig.analysis.tracing.selection.sizes import is_known_to
from rig.model.effect import Reach, Shape
from rig.model.effects import LIBRARY
from rig.model.effects.quadratic_drag import QuadraticDrag
from rig.model.effects.stribeck_friction import StribeckFriction

PLAINLY: Final = 300.0  # nats
KNOWN: Final = 0.1  # of the drag
LAWS: Final[Sequence[Shape]] = tuple(
    (delta, 0.0, law)
    for delta, law in (
        (2.0, StribeckFriction.EXPONENTIAL),
        (1.0, StribeckFriction.EXPONENTIAL),
        (2.0, StribeckFriction.FILM),
    )
)
"""The textbooks', behind the speed over which it falls."""


def two_for_one(s: Solution, runs: Sequence[int], covered: Reach) -> Solution:
    """`s` with a fall and a drag in the place of a fall alone, where those fit plainly better; else `s` itself."""
    terms = s.design.terms
    falls = [i for i, term in enumerate(terms) if term.name == StribeckFriction.name]
    if len(falls) != 1 or any(term.name == QuadraticDrag.name for term in terms):
        return s
    drag = Term(LIBRARY[QuadraticDrag.name], SQUARE)
    if not drag.effect.needs <= covered.has or not drag.effect.shapes(covered):
        return s
    bare, fall = extended(reduced(s.design, falls), drag, runs), terms[falls[0]]
    tried = [refine(bare, Term(fall.effect, (fall.shape[0], *law)), runs, covered)[1] for law in LAWS]
    best = max(tried, key=lambda one: one.gain)
    if best.gain - s.gain < PLAINLY:
        return s
    drags, *_ = effects(best, runs)[QuadraticDrag.name]
    return best if drags.value > 0 and is_known_to(KNOWN, drags) else s
