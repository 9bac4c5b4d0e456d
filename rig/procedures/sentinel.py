"""The same short run again and again through a campaign: has the rig changed?"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from rig.procedures.open_loop import Pushed


@dataclass(frozen=True)
class Sentinel(Pushed):
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
