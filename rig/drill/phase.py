"""When a fault strikes: what the rig is doing then."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar

from rig.core.procedure import Procedure
from rig.drill.rig import DrillRig
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.stiffness_lock import StiffnessLock

Strike = Callable[[], None]
TRIANGLE = KinematicError(amplitude_deg=45.0, frequency=0.32, cycles=0.5)  # 9.6 rpm, half a cycle of 3.1 s
WINDING = StiffnessLock(tau_max=6.0, rate=6.0, cycles=1, hold=0.3, rates=(1.0,))  # 1 s a quarter


class Phase(ABC):
    """Prepares a rig and says when to strike."""

    name: ClassVar[str]
    procedure: ClassVar[Procedure] = TRIANGLE

    @abstractmethod
    def arrange(self, rig: DrillRig, strike: Strike) -> None:
        """Have `strike` called at the right moment of the run that comes next."""


class Idle(Phase):
    """Connected, nothing energised; a run is asked for afterwards."""

    name = "idle"

    def arrange(self, rig: DrillRig, strike: Strike) -> None:
        strike()
        rig.wire.wait_until(rig.wire.now() + 0.2)  # s, for it to take effect before the run


class Enabling(Phase):
    """On the way to OPERATION ENABLED."""

    name = "enabling"

    def arrange(self, rig: DrillRig, strike: Strike) -> None:
        rig.assembly.agenda.after(0.003, strike)  # s: between two transitions of the drive


class Tracking(Phase):
    """Turning at constant speed under the position loop."""

    name = "tracking"

    def arrange(self, rig: DrillRig, strike: Strike) -> None:
        rig.assembly.agenda.after(1.0, strike)  # s: 0.5 s at rest, then the first ramp, 0.78 s long


class Reversal(Phase):
    """Where the reference turns back."""

    name = "reversal"

    def arrange(self, rig: DrillRig, strike: Strike) -> None:
        rig.assembly.agenda.after(0.5 + 0.25 / TRIANGLE.frequency + 0.015, strike)  # s, enabling included


class Loaded(Phase):
    """Output locked, the gear wound up."""

    name = "locked and loaded"
    procedure = WINDING

    def arrange(self, rig: DrillRig, strike: Strike) -> None:
        rig.verbs["lock"]()
        rig.assembly.agenda.after(1.4, strike)  # s: at rest, then most of the first ramp


class Stopping(Phase):
    """Being brought to rest after the operator asked for it."""

    name = "stopping"

    def arrange(self, rig: DrillRig, strike: Strike) -> None:
        def stop() -> None:
            rig.interrupts.count += 1

        rig.assembly.agenda.after(1.0, stop)
        rig.assembly.agenda.after(1.004, strike)


PHASES: tuple[Phase, ...] = (Idle(), Enabling(), Tracking(), Reversal(), Loaded(), Stopping())
