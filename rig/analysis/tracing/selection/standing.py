"""Which names stand beside a rest that has none."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.thresholds import MISSING
from rig.model.effects import LIBRARY


def standing(
    coordinate: str, names: Sequence[str], scores: Sequence[HeldOutScore], plain: Collection[str], told: bool = True
) -> tuple[str, ...]:
    """Names that stand beside a rest: those `plain` to see; and where it can be `told` what much is, those beside which
    nothing is left in any channel they act in, nor in the runs they act in most; else those that stand whatever the
    floor is."""
    amiss = {score.name for score in scores if max(score.anywhere, score.left) > MISSING}
    sure = {score.name for score in scores if score.whatever_the_floor}
    clean = _beside(coordinate, [name for name in names if (name not in amiss if told else name in sure)])
    return tuple(name for name in names if name in plain or name in clean)


def _beside(coordinate: str, names: Sequence[str]) -> tuple[str, ...]:
    """Names that may stand beside a rest: one with memory would give its share to any law that remembers, and the mean
    curve of its loop to one that bends the spring."""
    if coordinate != "memory":
        return tuple(names)
    return tuple(name for name in names if not (LIBRARY[name].remembers or LIBRARY[name].backbone))
