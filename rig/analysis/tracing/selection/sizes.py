"""Whether an effect may as well be nothing, and how well its size is known, by the figures it is told with."""

from __future__ import annotations

from collections.abc import Sequence

from rig.analysis.tracing.thresholds import KNOWN
from rig.model.effect import Effect, Parameter


def may_be_nothing(effect: Effect, words: Sequence[Parameter]) -> bool:
    """Whether the interval of every size of it contains zero; not of one that has none."""
    sizes = effect.sizes(words)
    return bool(sizes) and all(size.holds_zero for size in sizes)


def is_hardly_known(size: Parameter) -> bool:
    """Whether a size is known worse than to a third of itself: of 21 right names that stood beside one that did more
    the worst was known to a seventh, the wrong one (exam 30, case 40) to nine tenths."""
    return not is_known_to(KNOWN, size)


def is_known_to(times: float, figure: Parameter) -> bool:
    """Whether half the 95 % interval of a figure is no more than so many times itself."""
    return figure.ci95[1] - figure.ci95[0] <= 2 * times * abs(figure.value)
