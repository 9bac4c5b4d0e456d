"""Waves of the output's angle: once a turn, twice, or once with its overtones."""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.model.effect import Array, Fit, Parameter, Reach, Shape, harmonic
from rig.model.waves import wave

SWING: Final = 1 / 36  # of an output turn: less is a trend
LAST: Final = 5.0  # overtone: a lobe a fifth of a turn wide
WHOLE: Final = 0.9  # of an output turn: on less of it a few overtones are as good as any others
LEAST: Final = 0.7  # of the first order, an overtone at most: a narrow lobe has them nearly as large, a gear's has not


def once_or_twice(reach: Reach) -> tuple[Shape, ...]:
    """First and last order: 1 alone, 2 alone, 1 to 5, or 1 and 2 where the output goes no whole turn. On less than a
    sixth of one the first alone: a weight on the joint is large there, and what looks like it in the angle is asked
    beside it. () on next to none."""
    with_overtones = ((1.0, LAST if reach.load_turns > WHOLE else 2.0),) if reach.load_turns > 1 / 2 else ()
    if reach.load_turns <= 1 / 6:
        return ((1.0, 1.0),) if reach.load_turns > SWING else ()
    return ((1.0, 1.0), (2.0, 2.0), *with_overtones)


def orders(shape: Shape) -> Array:
    """From the first to the last, (k,)."""
    return np.arange(shape[0], shape[1] + 1.0)


def waves(angle: Array, shape: Shape) -> Array:
    """Cosine and sine of every order's multiple of `angle` (n,): (n, 2k)."""
    return np.hstack([wave(k * angle) for k in orders(shape)])


def slopes(waves: Array, shape: Shape) -> Array:
    """Of those columns, by the angle, (n, 2k)."""
    out = np.empty_like(waves)
    out[:, ::2], out[:, 1::2] = -orders(shape) * waves[:, 1::2], orders(shape) * waves[:, ::2]
    return out


def amplitudes(fit: Fit, unit: str, of: str = "") -> tuple[Parameter, ...]:
    """Amplitude and phase of every order, and `of` what, in their names."""
    found = [harmonic(fit, f"order_{k:g}{of}", unit, first=2 * i) for i, k in enumerate(orders(fit.shape))]
    return tuple(p for pair in found for p in pair)


def below_the_first(fit: Fit) -> bool:
    """Whether every overtone is smaller than the wave it is one of."""
    return _below(fit, 1)


def below_the_first_two(fit: Fit) -> bool:
    """Whether every overtone is smaller than what comes once or twice a turn."""
    return _below(fit, 2)


def _below(fit: Fit, count: int) -> bool:
    sizes = np.hypot(fit.coefficients[::2], fit.coefficients[1::2])
    return bool(sizes[count:].max(initial=0.0) < LEAST * sizes[:count].max())
