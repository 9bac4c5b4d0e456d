"""Which panes there are, and where: one arrangement per kind of procedure, the right plots at the first glance."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from enum import Enum, auto

from rig.core.kinds import OTHER, Regime, regime_of
from rig.procedures import CATALOGUE, procedure_class

PAST = 30.0  # s: four turns of a wave generator at the usual 9.6 rpm


class Kind(Enum):
    """What a pane shows."""

    TIME = auto()  # curves over time
    PLANE = auto()  # x against y, frame and numbers drawn by us
    SPACE = auto()  # the rig
    BARS = auto()
    LOG = auto()
    PAGE = auto()


@dataclass(frozen=True)
class Pane:
    """One view of the paths below `path`."""

    kind: Kind
    path: str
    name: str
    legend: bool = False  # where several curves share it


@dataclass(frozen=True)
class Group:
    """Panes beside or below each other, with their shares of the room."""

    upright: bool  # below each other
    parts: tuple[Pane | Group, ...]
    shares: tuple[float, ...]


@dataclass(frozen=True)
class Layout:
    """The whole window, and which time the curves show: from, to [s of the run]; None: the last PAST seconds."""

    root: Group
    span: tuple[float, float] | None


def below(*parts: tuple[float, Pane | Group]) -> Group:
    """(share, pane) pairs from top to bottom."""
    return Group(True, tuple(part for _, part in parts), tuple(share for share, _ in parts))


def beside(*parts: tuple[float, Pane | Group]) -> Group:
    """(share, pane) pairs from left to right."""
    return Group(False, tuple(part for _, part in parts), tuple(share for share, _ in parts))


PAGE = Pane(Kind.PAGE, "/page", "Run")
RIG = Pane(Kind.SPACE, "/rig", "Rig (deformation exaggerated)")
LOG = Pane(Kind.LOG, "/events", "State, events, trips")
FOLDED = Pane(Kind.PLANE, "/folded", "Kinematic error against wave-generator angle")
WIND_UP = Pane(Kind.PLANE, "/wind_up", "Shaft torque against wind-up")
LOSS = Pane(Kind.PLANE, "/loss", "Shaft torque less that of a straight spring")
STRIBECK = Pane(Kind.PLANE, "/stribeck", "Motor torque against speed")
ORDERS = Pane(Kind.BARS, "/orders", "Orders per motor turn, amplitude [arcsec]")
ANGLE = Pane(Kind.TIME, "/curves/angle", "Angles at the output θ_ref/N, θ_m/N, θ_l [deg]", legend=True)
FOLLOWING = Pane(Kind.TIME, "/curves/following", "Following error θ_ref − θ_m of the motor [deg]")
ERROR = Pane(Kind.TIME, "/curves/error", "θ̃ = θ_m/N − θ_l [arcsec]")
SPEED = Pane(Kind.TIME, "/curves/speed", "Motor speed ω_m [rpm]")
MOTOR = Pane(Kind.TIME, "/curves/motor", "Motor torque [N·m]", legend=True)
SHAFT = Pane(Kind.TIME, "/curves/shaft", "Shaft torque τ_l [N·m]")
TICK = Pane(Kind.TIME, "/curves/tick", "Lateness and age of a row [ms]", legend=True)


def layout_for(
    procedure: str,
    title: str,
    span: tuple[float, float] | None,
    absent: Collection[str] = (),
    more: Sequence[Pane] = (),
) -> Layout:
    """The arrangement for a procedure: its name as in the manifest, and what people call it.

    Panes whose paths are `absent` are left out, `more` of them come below the curves.
    """
    whole = _whole(procedure, title)
    middle = whole.parts[1]
    assert isinstance(middle, Group)
    parts = (
        whole.parts[0],
        below(*zip(middle.shares, middle.parts, strict=True), *((2, p) for p in more)),
        whole.parts[2],
    )
    return Layout(_without(Group(whole.upright, parts, whole.shares), absent), span)


def _whole(procedure: str, title: str) -> Group:
    regime = procedure_class(title).regime if procedure == OTHER and title in CATALOGUE else regime_of(procedure)
    arranged = {Regime.LOCKED: _locked, Regime.LOSSES: _losses, Regime.AT_REST: _at_rest}
    return arranged.get(regime, _turning)()


def _without(group: Group, absent: Collection[str]) -> Group:
    """The group without some panes, and without groups that are empty then."""
    parts = [_without(part, absent) if isinstance(part, Group) else part for part in group.parts]
    kept = [
        (share, part)
        for share, part in zip(group.shares, parts, strict=True)
        if (part.parts if isinstance(part, Group) else part.path not in absent)
    ]
    return Group(group.upright, tuple(part for _, part in kept), tuple(share for share, _ in kept))


def _turning() -> Group:
    """The gear turns: the picture of the rig is the kinematic error over one turn."""
    return beside(
        (5, below((3, FOLDED), (1.7, ORDERS), (1.7, ERROR))),
        (4, below((2, ANGLE), (2, FOLLOWING), (2, SPEED), (2, MOTOR), (2, SHAFT))),
        (3.4, _margin()),
    )


def _locked() -> Group:
    return beside(
        (5, below((3, WIND_UP), (3, LOSS))),
        (4, below((2, SHAFT), (2, ANGLE), (2, FOLLOWING), (2, MOTOR), (2, SPEED))),
        (3.4, _margin()),
    )


def _losses() -> Group:
    return beside(
        (5, below((3, STRIBECK), (2, MOTOR))),
        (4, below((2, SPEED), (2, ANGLE), (2, SHAFT), (2, ERROR))),
        (3.4, _margin()),
    )


def _at_rest() -> Group:
    return beside(
        (5, below((2, ERROR), (2, SHAFT), (2, MOTOR))),
        (4, below((2, ANGLE), (2, FOLLOWING), (2, SPEED))),
        (3.4, _margin()),
    )


def _margin() -> Group:
    """What is the same for all: what this is, the rig, how the loop does, what happened."""
    return below((2.0, PAGE), (3.2, RIG), (1.3, TICK), (1.6, LOG))
