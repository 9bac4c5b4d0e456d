"""A form: one functional shape of one hidden effect, put into the plant or the sensors at a given strength."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tests.blind.builder import Builder

Parameters = dict[str, float]
Build = Callable[[Builder, np.random.Generator, float], Parameters]


@dataclass(frozen=True)
class Form:
    """`build(builder, rng, strength)` changes the builder and returns the native parameters, SI.

    It draws its shape from `rng` before it uses `strength`, so the same seed gives the same shape at every strength.
    `textbook` marks the law of the field's textbooks; the other forms are what a tracer's library need not hold.
    `weakest` and `strongest` bound the strength where the effect stays physically possible; 1 is a typical rig.
    `coordinates`: where the residual of an effect without a name lives, the best answer first.
    """

    effect: str
    name: str
    build: Build
    textbook: bool = False
    weakest: float = 0.02
    strongest: float = 3.0
    coordinates: tuple[str, ...] = ()


def pick(rng: np.random.Generator, low: float, high: float) -> float:
    return float(rng.uniform(low, high))


def phase(rng: np.random.Generator) -> float:
    return float(rng.uniform(0, 2 * np.pi))
