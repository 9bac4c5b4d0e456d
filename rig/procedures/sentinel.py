"""The same short run again and again through a campaign: has the rig changed?"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.procedures.open_loop import OpenLoop


@dataclass(frozen=True)
class Sentinel(Procedure):
    """A short run at constant torque whose mean speed, torque, peak to peak and order 2 are compared over a campaign.

    By itself each finds its own torque: friction shows in the torque, and in nothing else that could be compared. With
    one `torque` given to all it shows in the speed.
    """

    name: ClassVar[str] = "sentinel"
    checks: ClassVar[bool] = True
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l")

    speed_rpm: float = field(default=310.0, metadata={"signed": True})  # of the motor
    revolutions: int = 25  # 5 s at 310 rpm, enough to tell 1 % of order 2
    settle: float = 3.0  # s of constant torque before
    torque: float = field(default=0.0, metadata={"signed": True})  # N·m, sign of the speed; 0: find it

    def __post_init__(self) -> None:
        _ = self.plan  # refuses what cannot be meant

    @property
    def plan(self) -> OpenLoop:
        """The same in SI."""
        return OpenLoop(self.speed_rpm, self.revolutions, self.settle, self.torque)

    def envelope(self, setting: Setting) -> Envelope:
        """As a constant-torque run."""
        return self.plan.envelope(setting)

    def remarks(self, setting: Setting) -> list[str]:
        """Where a torque that is given takes the motor."""
        return self.plan.remarks(setting)

    def conditions(self) -> dict[str, Any]:
        """For the manifest; `settle_s` tells the analysis what to leave out."""
        return self.plan.conditions()

    def steps(self, setting: Setting) -> Steps:
        """Up, held, let run, down."""
        return self.plan.steps(setting)
