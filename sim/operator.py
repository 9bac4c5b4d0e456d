"""The twin's own hand: hangs the weight and fits the pin in the simulated world, at once and without complaint."""

from __future__ import annotations

from rig.core.errors import NotReady
from rig.core.operator import Change, ClearFault, FreeOutput, HangWeight, LockOutput, Operator, Reassemble
from sim.world import World


class TwinOperator(Operator):
    """Acts on the twin's `world` directly."""

    begins_anew = True

    def __init__(self, world: World) -> None:
        self.world = world

    def make(self, change: Change) -> None:
        """Raises NotReady for what the twin cannot do."""
        match change:
            case HangWeight(tau_ext):
                self.world.load_torque(tau_ext)
            case LockOutput():
                self.world.lock_output()
            case FreeOutput():
                self.world.unlock_output()
            case Reassemble(depth_mm):
                self.world.reassemble(depth_mm)
            case ClearFault():
                return  # nothing of the twin breaks
            case _:
                raise NotReady(f"the twin cannot do this: {change.words()}")
