"""Friction that is larger one way than the other has a part that keeps its sign when the motor turns back, as cogging
does: with the same orders and phases, and smaller."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.thresholds import IN_PHASE, ONE_SIDED
from rig.model.effect import Parameter

FRICTION, COGGING = "position_dependent_friction", "cogging_torque"


@dataclass(frozen=True)
class _Wave:
    amplitude: float  # N·m
    half_amplitude: float  # of its 95 % interval
    phase: float  # rad
    half: float  # of the phase's


def one_sided(words: Mapping[str, Sequence[Parameter]]) -> str:
    """What to say of a cogging torque that is no more than the difference of friction between the two ways, given the
    parameters by effect; "" where it is one of its own, or there is none."""
    friction, cogging = (_waves(words.get(name, ())) for name in (FRICTION, COGGING))
    if not cogging or not cogging.keys() <= friction.keys():
        return ""
    shares = [_share(cogging[order], friction[order]) for order in cogging]
    if not (all(share > 0 for share in shares) or all(share < 0 for share in shares)):
        return ""
    order = max(cogging, key=lambda order: cogging[order].amplitude)
    wave = cogging[order]
    more = "forward" if shares[0] > 0 else "backward"
    return (
        f"Friction along a turn of the motor is larger {more}: {1e3 * wave.amplitude:.3g} ± "
        f"{1e3 * wave.half_amplitude:.2g} mN·m of order {order} keep their sign when the motor turns back, with its "
        "phase or against it, and are not taken for cogging."
    )


def _share(even: _Wave, odd: _Wave) -> float:
    """Of the friction, positive where more of it is forward; 0 where it is another wave."""
    apart = np.angle(np.exp(1j * (even.phase - odd.phase)))
    sign = 1.0 if abs(apart) < np.pi / 2 else -1.0
    away = abs(apart) if sign > 0 else np.pi - abs(apart)
    share = even.amplitude / odd.amplitude
    return float(sign * share) if share < ONE_SIDED and away < IN_PHASE + even.half + odd.half else 0.0


def _waves(parameters: Sequence[Parameter]) -> dict[str, _Wave]:
    """By order."""
    by = {p.name: p for p in parameters}
    orders = [name.split("_")[1] for name in by if name.endswith("_amplitude")]
    return {n: _Wave(*_with_half(by[f"order_{n}_amplitude"]), *_with_half(by[f"order_{n}_phase"])) for n in orders}


def _with_half(p: Parameter) -> tuple[float, float]:
    """Value, and half its 95 % interval."""
    return p.value, (p.ci95[1] - p.ci95[0]) / 2
