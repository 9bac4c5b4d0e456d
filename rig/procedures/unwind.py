"""Let out what a locked gear still holds: after a trip or a halt, friction may keep it wound up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from rig.core.errors import NotReady
from rig.core.kinds import Regime
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.procedures.stiffness_lock import PATIENCE, SLIP, StiffnessLock

MOST = 45.0  # N·m a locked gear may hold: friction of the motor times N, and the sensors of such rigs end at 50 N·m


@dataclass(frozen=True)
class Unwind(Procedure):
    """Turn the motor of a locked gear back along a ramp until the shaft shows next to no torque: then the pin may be
    pulled. What friction of the motor holds in the end is a slip of it, told with what was let out."""

    name: ClassVar[str] = "other"
    label: ClassVar[str] = "unwind"
    regime: ClassVar[Regime] = Regime.LOCKED
    answers: ClassVar[bool] = True
    checks: ClassVar[bool] = True
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "tau_l")
    output_locked: ClassVar[bool] = True

    rate: float = 5.0  # N·m/s at the shaft

    def envelope(self, setting: Setting) -> Envelope:
        """For the most a gear may hold; it ends as soon as nothing is left."""
        wind_up = setting.ratio * MOST / setting.stiffness
        duration = PATIENCE * MOST / self.rate + 2.0  # as the lock test allows itself, and 2 s to spare
        return Envelope(duration, 2 * wind_up, wind_up * self.rate / MOST, setting.control.torque_limit)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        return {"output_locked": True, "note": "unwinding before the lock pin is pulled"}

    def steps(self, setting: Setting) -> Steps:
        """As the lock test does when it is stopped. Returns an Unwound. Raises NotReady where the shaft still shows
        more than a slip of the motor leaves."""
        unwound = yield from StiffnessLock(unwind_rate=self.rate).to_rest(setting)
        if abs(unwound.after) > SLIP:
            raise NotReady(
                f"{unwound.sentence}; a slip of the motor leaves {SLIP:g} N·m at most: the pin stays in. Run unwind "
                "once more; if that changes nothing, is the sign of torque, and the zero of the torque sensor, right?"
            )
        return unwound
