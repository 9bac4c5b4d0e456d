"""All the runs that the parameters of one gear are found from, at the end of which stands a gear file."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from rig.campaign.plan import StepSection
from rig.campaign.sweeps import Sweep
from rig.core.errors import UsageError

SPEEDS = (120.0, 200.0, 300.0, 400.0, 500.0)  # rpm: on both sides of where orders 2 to 15 meet the paper's 25 Hz mode


@dataclass(frozen=True)
class Identify(Sweep):
    """Slow run, friction, constant torque at several speeds both ways, lock test; then a gear file with intervals.

    Weights are left out: nothing of the model is found from them. With the torque sensor, about 20 minutes of rig time.
    """

    speeds_rpm: tuple[float, ...] = field(default=SPEEDS, metadata={"signed": True})  # of the motor, each way
    cycles: float = 2.0  # of the slow triangle
    revolutions: int = 60  # at each speed, open loop
    friction_rpm: str = "5,10,20,50,100,200,300,500"  # of the motor, each way under the position loop
    lock_cycles: int = 3  # of the lock test, at the first of its rates
    lock_rate: float = 0.75  # N·m/s at the torque sensor: 20 s a quarter

    def sections(self) -> list[StepSection]:
        """Lock test last: what it winds up has gone before anything turns again."""
        speeds = sorted({abs(speed) for speed in self.speeds_rpm})
        if len(speeds) < 2:
            raise UsageError(
                "speeds_rpm: expected at least two speeds; drag and inertias show in what changes with them"
            )
        return [
            _section("kinematic-error", cycles=self.cycles),
            _section("friction", speeds_rpm=self.friction_rpm),
            *(
                _section("constant-torque", speed_rpm=way * speed, revolutions=self.revolutions)
                for way in (1.0, -1.0)
                for speed in speeds
            ),
            _section("stiffness-lock", cycles=self.lock_cycles, rate=self.lock_rate),
        ]


def _section(procedure: str, **parameters: Any) -> StepSection:
    return StepSection.model_validate({"procedure": procedure, "with": parameters, "note": "identification"})
