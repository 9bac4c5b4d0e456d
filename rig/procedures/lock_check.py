"""Does the lock pin hold the output? A small turn of the motor winds the gear up, or turns the load."""

from __future__ import annotations

import math
import statistics
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from rig.control.pid import Pid
from rig.control.profile import Trapezoid
from rig.core.kinds import Regime
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Sample, Torque
from rig.core.units import DEG
from rig.procedures.stiffness_lock import OVERSHOOT_BY

OVERSHOOT = 2.0  # of the wind-up, and OVERSHOOT_BY: stick-slip, or a gear that was wound up before


class LockProof(NamedTuple):
    """What moved when the motor was turned a little."""

    motor: float  # rad
    load: float  # rad
    shaft_torque: float  # N·m more than before; NaN without a sensor
    follows: float  # load over motor/N: 0 locked, 1 free
    sentence: str


@dataclass(frozen=True)
class LockCheck(Procedure):
    """Turn the motor a few degrees under its position loop, hold, turn back the same way: nothing stays wound up."""

    name: ClassVar[str] = "other"
    label: ClassVar[str] = "lock-check"
    regime: ClassVar[Regime] = Regime.LOCKED
    answers: ClassVar[bool] = True
    checks: ClassVar[bool] = True
    output_locked: ClassVar[bool] = True
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l")

    angle_deg: float = 3.0  # deg of the motor: 7.5 N·m on a locked output at 7160 N·m/rad and N = 50
    hold: float = 0.5  # s at the far end

    @property
    def move(self) -> Trapezoid:
        """Out in half a second or so."""
        return Trapezoid(self.angle_deg * DEG, 6 * DEG, 60 * DEG)

    def envelope(self, setting: Setting) -> Envelope:
        """The guard keeps the wind-up small, by the shaft torque and by the following error."""
        duration = 2 * self.move.duration + 3 * self.hold
        wound = setting.stiffness * self.angle_deg * DEG / setting.ratio
        shaft = OVERSHOOT * wound + OVERSHOOT_BY if wound > 0 else math.inf  # NaN: no stiffness declared
        torque = setting.control.torque_limit
        return Envelope(duration, self.angle_deg * DEG, self.move.speed, torque, shaft_torque=shaft)

    def conditions(self) -> dict[str, object]:
        """For the manifest."""
        return {"output_locked": True, "note": "check of the lock pin"}

    def steps(self, setting: Setting) -> Steps:
        """Returns a LockProof."""
        pid, move = Pid(setting.control, setting.period), self.move
        sample = yield Torque(0.0)
        begin, home = sample.t, sample.theta_m
        before: list[Sample] = []
        held: list[Sample] = []
        turn_back = self.hold + move.duration + self.hold
        while (t := sample.t - begin) < turn_back + move.duration + self.hold:
            if t < self.hold:
                before.append(sample)
            elif turn_back - self.hold / 2 < t < turn_back:
                held.append(sample)
            out, back = move.at(t - self.hold), move.at(t - turn_back)
            theta_ref, omega_ref = home + out[0] - back[0], out[1] - back[1]
            sample = yield Torque(pid.step(theta_ref, omega_ref, sample.theta_m, sample.omega_m), theta_ref, omega_ref)
        return lock_proof(before, held, setting.ratio)


def lock_proof(before: list[Sample], held: list[Sample], ratio: float) -> LockProof:
    """What moved between the two stretches of samples."""
    motor = statistics.fmean(s.theta_m for s in held) - statistics.fmean(s.theta_m for s in before)
    load = statistics.fmean(s.theta_l for s in held) - statistics.fmean(s.theta_l for s in before)
    shaft = statistics.fmean(s.tau_l for s in held) - statistics.fmean(s.tau_l for s in before)
    follows = load * ratio / motor if motor else math.nan
    sentence = (
        f"the motor turned {motor / DEG:+.2f}°, the load {load / DEG:+.4f}° "
        f"({100 * follows:.0f} % of what would follow), shaft torque {shaft:+.2f} N·m"
    )
    return LockProof(motor, load, shaft, follows, sentence)
