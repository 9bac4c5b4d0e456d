"""What an effect does in each block, and what is left there with it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Design, Solution
from rig.model.effect import Array

Noise = dict[tuple[str, str], tuple[float, float]]
"""By procedure and channel, mean square of what an effect does there, and mean of that times what is left, in the
block's own unit squared."""


@dataclass(frozen=True)
class Without:
    """An effect taken away: the fit without it, what is left in every block of a design with it and without, (n,), and
    what sensor noise makes of it, as `noise_in` says."""

    rest: Solution
    design: Design
    left: Mapping[Key, Array]
    bare: Mapping[Key, Array]
    noise: Noise

    def spoilt(self, key: Key) -> tuple[float, float]:
        """Of its noise what is in that block."""
        return self.noise.get((self.design.eq.runs[key[0]].procedure, key[1]), (0.0, 0.0))


def done(one: Without, floors: Mapping[Key, float], parts: int = 1) -> Iterator[tuple[Key, int, Array, Array]]:
    """Block, part of the run, what the effect does there and what is left with it, both over the floor (n,)."""
    for key in one.left:
        e = one.left[key] / floors[key]
        f = one.bare[key] / floors[key] - e
        for part, (mine, left) in enumerate(zip(np.array_split(f, parts), np.array_split(e, parts), strict=True)):
            yield key, part, mine, left


def noise_in(s: Solution, rests: Sequence[Solution]) -> list[Noise]:
    """What sensor noise makes of each effect, `rests` being the fits without one. It is known of a fast and a slow run
    of each procedure, and may grow with the speed: the lesser is taken."""
    d, x = s.design, together(s, rests)
    found: list[Noise] = [{} for _ in rests]
    for key in d.noise:
        left, *bare = d.noise_left(key, x).T
        like = (d.eq.runs[key[0]].procedure, key[1])
        for noise, e in zip(found, bare, strict=True):
            made = e - left
            both = float(np.mean(made**2)), float(np.mean(made * left))
            noise[like] = min(both, noise.get(like, both))
    return found


def together(s: Solution, rests: Sequence[Solution]) -> Array:
    """Coefficients of all fits side by side, (p, 1 + k): what they make of a block is one product, and a matrix takes
    longer to read than to multiply."""
    return np.stack([s.x, *(rest.x for rest in rests)], 1)
