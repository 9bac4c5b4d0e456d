"""Nothing moves because the loop holds it: what the drive and the loop add to the noise of a standstill."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from rig.control.pid import Pid
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.procedures.standstill import CREEP


@dataclass(frozen=True)
class HeldStandstill(Procedure):
    """Stand still under the position loop: read beside a standstill without torque, it shows what the loop shakes."""

    name: ClassVar[str] = "standstill"
    label: ClassVar[str] = "held-standstill"
    checks: ClassVar[bool] = True
    needs: ClassVar[tuple[str, ...]] = ("theta_m",)

    duration: float = 30.0  # s, at rest

    def envelope(self, setting: Setting) -> Envelope:
        """No travel to speak of; the torque is what the loop may give."""
        return Envelope(self.duration, CREEP, 0.0, setting.control.torque_limit)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        return {"output_locked": False, "tau_ext": 0.0, "speed_rpm": 0.0, "note": "held by the position loop"}

    def steps(self, setting: Setting) -> Steps:
        """Hold the motor where it stands."""
        pid = Pid(setting.control, setting.period)
        sample = yield Torque(0.0)
        home = sample.theta_m
        while sample.t < self.duration:
            sample = yield Torque(pid.step(home, 0.0, sample.theta_m, sample.omega_m), home)
