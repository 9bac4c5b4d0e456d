"""What an effect does in each block, and what is left there with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

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


def noise_in(s: Solution, rest: Solution) -> Callable[[Key], tuple[float, float]]:
    """What sensor noise makes of an effect in a block: mean square of what it does there, and mean of that times what
    is left, in the block's own unit squared. It is known of a fast and a slow run of each procedure, and may grow with
    the speed: the lesser is taken. `rest` is the fit without the effect."""
    eq = s.design.eq
    found: dict[tuple[str, str], tuple[float, float]] = {}
    for key in s.design.noise:
        left = s.design.noise_left(key, s.x)
        made = s.design.noise_left(key, rest.x) - left
        like = (eq.runs[key[0]].procedure, key[1])
        both = float(np.mean(made**2)), float(np.mean(made * left))
        found[like] = min(both, found.get(like, both))
    return lambda key: found.get((eq.runs[key[0]].procedure, key[1]), (0.0, 0.0))
