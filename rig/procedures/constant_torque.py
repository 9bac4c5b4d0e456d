"""What becomes of the kinematic error at speed: the motor pushed by one torque that nothing corrects."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from rig.procedures.open_loop import Pushed


@dataclass(frozen=True)
class ConstantTorque(Pushed):
    """Find the torque that holds a mean speed, then give exactly that, open loop, and watch      [ghorbel2001, Fig. 11]

    No loop corrects anything while it is measured: what the speed does is the gear's doing. In the run the rows of
    that part have no `theta_ref` and one and the same `tau_ask`; the first `settle` seconds of them are left out.
    """

    name: ClassVar[str] = "constant_torque"
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l")

    speed_rpm: float = field(default=310.0, metadata={"signed": True})  # of the motor
    revolutions: int = 60  # of the wave generator, measured open loop
    settle: float = 5.0  # s of constant torque before; the speed settles with J/B, 0.4 s on the paper's rig
    torque: float = field(default=0.0, metadata={"signed": True})  # N·m, sign of the speed; 0: find it
