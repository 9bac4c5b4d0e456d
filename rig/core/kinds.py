"""The kinds of run: how a manifest's `procedure` names them, what people call them, and what the motor does in them.

One table that import, analysis, limits, reports and the live view follow. A run of no kind here is one of `other`, with
a label of its own.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, auto
from typing import Final, NamedTuple


class Regime(Enum):
    """What the motor does in a run, which decides what it can tell."""

    SLOW = auto()  # turns so slowly that θ̃ is the pure kinematic error
    AT_SPEED = auto()  # turns fast: θ̃ holds what flexibility adds
    LOCKED = auto()  # winds the gear up against an output held fast
    LOSSES = auto()  # turns for the sake of friction and inertia, whatever θ̃ does meanwhile
    AT_REST = auto()
    OTHER = auto()


class Kind(NamedTuple):
    """One kind of run."""

    title: str  # of a page, for people
    regime: Regime


OTHER: Final = "other"
KINDS: Final[Mapping[str, Kind]] = {
    "kinematic_error": Kind("Kinematic error", Regime.SLOW),
    "speed_convergence": Kind("Kinematic error at decreasing speeds", Regime.SLOW),
    "full_turn": Kind("Kinematic error over a full output turn", Regime.SLOW),
    "constant_torque": Kind("Run at constant torque", Regime.AT_SPEED),
    "constant_speed": Kind("Run at constant speed", Regime.AT_SPEED),
    "load_sweep": Kind("Kinematic error under load", Regime.SLOW),
    "assembly_sweep": Kind("Kinematic error and assembly depth", Regime.SLOW),
    "stiffness_lock": Kind("Torsional stiffness, output locked", Regime.LOCKED),
    "friction": Kind("Friction", Regime.LOSSES),
    "coast_down": Kind("Coast-down", Regime.LOSSES),
    "standstill": Kind("Standstill", Regime.AT_REST),
    "sentinel": Kind("Sentinel run", Regime.AT_SPEED),
    OTHER: Kind("Measured motion", Regime.OTHER),
}


def regime_of(procedure: str) -> Regime:
    """What the motor does in a run of this kind; OTHER of a kind unheard of."""
    return KINDS.get(procedure, KINDS[OTHER]).regime


def kinds_of(*regimes: Regime) -> tuple[str, ...]:
    """The kinds in which the motor does one of these."""
    return tuple(name for name, kind in KINDS.items() if kind.regime in regimes)
