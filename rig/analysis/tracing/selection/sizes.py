"""Whether an effect may as well be nothing, by the sizes it is told with."""

from __future__ import annotations

from collections.abc import Sequence

from rig.model.effect import Effect, Parameter


def may_be_nothing(effect: Effect, words: Sequence[Parameter]) -> bool:
    """Whether the interval of every size of it contains zero; not of one that has none."""
    sizes = effect.sizes(words)
    return bool(sizes) and all(size.holds_zero for size in sizes)
