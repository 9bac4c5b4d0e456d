"""Random numbers of the twin: one stream per purpose, so that adding a reader never changes what another one sees."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator

import numpy as np

BLOCK = 4096  # deviates drawn at a time; one by one they would cost more than the plant


def generator(seed: int, purpose: str) -> np.random.Generator:
    """The random generator of one purpose."""
    return np.random.default_rng([seed, zlib.crc32(purpose.encode())])


def normal(seed: int, purpose: str, sigma: float = 1.0) -> Callable[[], float]:
    """A function that gives the next normal deviate of standard deviation `sigma`."""

    def stream() -> Iterator[float]:
        source = generator(seed, purpose)
        while True:
            yield from (sigma * source.standard_normal(BLOCK)).tolist()

    return stream().__next__
