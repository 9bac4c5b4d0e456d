"""What an effect does in each block, and what is left there with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Design, Solution
from rig.model.effect import Array


@dataclass(frozen=True)
class Without:
    """An effect taken away: the fit with it, that without it, and what they leave in every block of a design, (n,)."""

    whole: Solution
    rest: Solution
    design: Design
    left: Mapping[Key, Array]
    bare: Mapping[Key, Array]


def done(one: Without, floors: Mapping[Key, float], parts: int = 1) -> Iterator[tuple[Key, int, Array, Array]]:
    """Block, part of the run, what the effect does there and what is left with it, both over the floor (n,)."""
    for key in one.left:
        e = one.left[key] / floors[key]
        f = one.bare[key] / floors[key] - e
        for part, (mine, left) in enumerate(zip(np.array_split(f, parts), np.array_split(e, parts), strict=True)):
            yield key, part, mine, left


def noise_in(one: Without) -> Callable[[Key], tuple[float, float]]:
    """What sensor noise makes of an effect in a block: mean square of what it does there, and mean of that times what
    is left, in the block's own unit squared. It is known of a fast and a slow run of each procedure, and may grow with
    the speed: the lesser is taken."""
    d = one.whole.design
    eq = d.eq
    found: dict[tuple[str, str], tuple[float, float]] = {}
    for key in d.noise:
        left = d.noise_left(key, one.whole.x)
        made = d.noise_left(key, one.rest.x) - left
        like = (eq.runs[key[0]].procedure, key[1])
        both = float(np.mean(made**2)), float(np.mean(made * left))
        found[like] = min(both, found.get(like, both))
    return lambda key: found.get((eq.runs[key[0]].procedure, key[1]), (0.0, 0.0))
