"""Friction that is larger one way than the other has a part that keeps its sign when the motor turns back, as cogging
does: with the same orders and phases, and smaller."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.model.effect import Parameter

FRICTION, COGGING = "position_dependent_friction", "cogging_torque"
LARGEST: Final = 0.5  # of the friction: it is three times as large one way as the other then
ALIKE: Final = 0.1  # rad between the two phases, beside what their intervals leave open: chance gets there in 6 of 100


@dataclass(frozen=True)
class _Wave:
    amplitude: float
    phase: float
    half: float  # of the phase's interval


def one_sided(words: Mapping[str, Sequence[Parameter]]) -> str:
    """What to say of a cogging torque that is no more than the difference of friction between the two ways, given the
    parameters by effect; "" where it is one of its own, or there is none."""
    friction, cogging = (_waves(words.get(name, ())) for name in (FRICTION, COGGING))
    if not cogging or not cogging.keys() <= friction.keys():
        return ""
    shares = [_share(cogging[order], friction[order]) for order in cogging]
    if not (all(share > 0 for share in shares) or all(share < 0 for share in shares)):
        return ""
    largest = max(cogging, key=lambda order: cogging[order].amplitude)
    more = "forward" if shares[0] > 0 else "backward"
    return (
        f"Friction along a turn of the motor is larger {more}: {cogging[largest].amplitude:.2g} N·m of order "
        f"{largest} keep their sign when the motor turns back, in phase with it, and are not taken for cogging."
    )


def _share(even: _Wave, odd: _Wave) -> float:
    """Of the friction, positive where more of it is forward; 0 where it is another wave."""
    apart = np.angle(np.exp(1j * (even.phase - odd.phase)))
    sign = 1.0 if abs(apart) < np.pi / 2 else -1.0
    away = abs(apart) if sign > 0 else np.pi - abs(apart)
    share = even.amplitude / odd.amplitude
    return float(sign * share) if share < LARGEST and away < ALIKE + even.half + odd.half else 0.0


def _waves(parameters: Sequence[Parameter]) -> dict[str, _Wave]:
    """By order."""
    by = {p.name: p for p in parameters}
    orders = [name.split("_")[1] for name in by if name.endswith("_amplitude")]
    return {
        n: _Wave(
            by[f"order_{n}_amplitude"].value,
            by[f"order_{n}_phase"].value,
            (by[f"order_{n}_phase"].ci95[1] - by[f"order_{n}_phase"].ci95[0]) / 2,
        )
        for n in orders
    }
