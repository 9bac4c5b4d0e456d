"""Nothing moves and nothing is commanded: what every channel says on its own, before a campaign and after it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque

CREEP = 0.1  # rad of the motor that it may move all the same; the guard adds its following limit


@dataclass(frozen=True)
class Standstill(Procedure):
    """Stand still without torque: noise, drift and zero of every channel.

    The drive is enabled and aims at zero torque, as it does before and after every run; what its switching does to the
    sensors is in the figures.
    """

    name: ClassVar[str] = "standstill"
    checks: ClassVar[bool] = True
    needs: ClassVar[tuple[str, ...]] = ("theta_m",)
    closes_loop: ClassVar[bool] = False

    duration: float = 30.0  # s, at rest

    def envelope(self, setting: Setting) -> Envelope:
        """No travel to speak of, no torque."""
        return Envelope(self.duration, CREEP, 0.0, 0.0)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        note = "drive enabled, zero torque commanded"
        return {"output_locked": False, "tau_ext": 0.0, "speed_rpm": 0.0, "note": note}

    def steps(self, setting: Setting) -> Steps:
        """Wait."""
        sample = yield Torque(0.0)
        while sample.t < self.duration:
            sample = yield Torque(0.0)
