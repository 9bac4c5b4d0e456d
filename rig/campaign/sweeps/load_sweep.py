"""What a load does to the kinematic error: the slow triangle under one weight after the other."""

from __future__ import annotations

from dataclasses import dataclass, field

from rig.campaign.plan import StepSection
from rig.campaign.sweeps import Sweep

WEIGHTS = (0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0)  # N·m; the paper's figure levels off beyond 7.5


@dataclass(frozen=True)
class LoadSweep(Sweep):
    """The slow triangle under each weight, from the lightest to the heaviest and back      [ghorbel2001, Fig. 9]

    Each weight comes twice, once on the way up and once on the way down: hysteresis of the load shows as a difference.
    """

    weights: tuple[float, ...] = field(default=WEIGHTS, metadata={"signed": True})  # N·m on the load
    amplitude_deg: float = 1440.0  # deg of the motor, zero to peak
    frequency: float = 0.01  # Hz, of the triangle
    cycles: float = 1.0  # under each weight, each way

    def sections(self) -> list[StepSection]:
        """Up, then down."""
        up = sorted(self.weights, key=abs)
        triangle = {"amplitude_deg": self.amplitude_deg, "frequency": self.frequency, "cycles": self.cycles}
        same = {"procedure": "kinematic-error", "with": triangle}
        return [
            StepSection.model_validate({**same, "weight": weight, "way": way, "note": f"load sweep, {way}"})
            for way, weights in (("up", up), ("down", up[::-1]))
            for weight in weights
        ]
