"""Whether an effect may as well be nothing, and how well its size is known, by the figures it is told with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.thresholds import KNOWN
from rig.model.effect import Effect, Parameter

DAMPING: Final = "zeta"
DAMPED: Final = 1.0  # ζ, from which on nothing swings; of 13 true resonances in five exams the widest is ± 0.05


def may_be_nothing(effect: Effect, words: Sequence[Parameter]) -> bool:
    """Whether the interval of every size of it contains zero, or it is a resonance that may as well not swing; not of
    one that has no size."""
    sizes = effect.sizes(words)
    return bool(sizes) and (all(size.holds_zero for size in sizes) or not _swings(words))


def _swings(words: Sequence[Parameter]) -> bool:
    """Whether a damping ratio, where there is one, is known to less than what damps a resonance away: of one that is
    not known so an inertia is left, or a compliance, and those the gear has."""
    ratios = [p for p in words if p.name.startswith(DAMPING)]
    return all(p.ci95[1] - p.ci95[0] < 2 * DAMPED for p in ratios)


def is_hardly_known(size: Parameter) -> bool:
    """Whether a size is known worse than to a third of itself: of 21 right names that stood beside one that did more
    the worst was known to a seventh, the wrong one (exam 30, case 40) to nine tenths."""
    return not is_known_to(KNOWN, size)


def is_known_to(times: float, figure: Parameter) -> bool:
    """Whether half the 95 % interval of a figure is no more than so many times itself."""
    return figure.ci95[1] - figure.ci95[0] <= 2 * times * abs(figure.value)
