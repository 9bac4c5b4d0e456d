"""What goes wrong in a drill, and what is expected of the program then."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from rig.drill.rig import DrillRig


class Expected(StrEnum):
    """How a run with this fault in it has to end."""

    TRIP = "trip"  # torque off, fault latched
    GO_ON = "go on"  # harmless: flagged or unseen, and the run completes


@dataclass(frozen=True)
class Cause:
    """One fault. `detection` is the declared time [s] the program may take to notice it, the control periods aside."""

    name: str
    strike: Callable[[DrillRig], object]
    detection: float
    expected: Expected = Expected.TRIP
    unseen: frozenset[str] = frozenset()  # phases in which it changes nothing that could be noticed
    or_stops: frozenset[str] = frozenset()  # phases in which a harmless one may end the run as well, with the reason
