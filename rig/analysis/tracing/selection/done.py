"""What an effect does in each block, and what is left there with it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Design, Solution
from rig.model.effect import Array


def done(
    s: Solution, rest: Solution, d: Design, floors: Mapping[Key, float], parts: int = 1
) -> Iterator[tuple[Key, int, Array, Array]]:
    """Block, part of the run, what the effect does there and what is left with it, both over the floor (n,). `rest` is
    the fit without the effect."""
    for key in d.y:
        e = d.residual(key, s.x) / floors[key]
        f = d.residual(key, rest.x) / floors[key] - e
        for part, (mine, left) in enumerate(zip(np.array_split(f, parts), np.array_split(e, parts), strict=True)):
            yield key, part, mine, left
