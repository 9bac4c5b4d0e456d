"""Let go at speed and watch: friction and inertia in one curve that no loop has touched."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from rig.control.brake import AT_REST, PATIENCE, REST_TIME, brake
from rig.control.spin import hold_duration, hold_speed, hold_travel
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.core.units import RPM

HOLD = 1.0  # s at speed whose mean torque is the friction there
PAUSE = 0.2  # s at rest between
HALF_A_TURN = math.pi  # rad


@dataclass(frozen=True)
class CoastDown(Procedure):
    """Spin up, hold, take the torque off, watch the motor come to rest; forward and reverse, `repeats` times.

    The torque that held the speed is the friction that then slows it down: their ratio is the inertia at the motor,
    J_m + J_l/N². In the run the coasting rows have `tau_ask` = 0 and no `theta_ref`.
    """

    name: ClassVar[str] = "coast_down"
    needs: ClassVar[tuple[str, ...]] = ("t", "theta_m")

    speed_rpm: float = 500.0  # of the motor; it rests after a tenth of a second, the faster the longer
    repeats: int = 8  # each way; each begins at another angle, where the kinematic error pushes another way

    def envelope(self, setting: Setting) -> Envelope:
        """The way of one spin: forward and reverse take each other back, all but what the coasting differs."""
        omega = self.speed_rpm * RPM
        coast = omega * PATIENCE / 2
        hold = hold_duration(omega, HOLD) + HALF_A_TURN / omega
        duration = 2 * self.repeats * (hold + PATIENCE + REST_TIME + PAUSE) + PATIENCE
        travel = hold_travel(omega, HOLD) + HALF_A_TURN + coast
        reserve = f"speed_rpm = {self.speed_rpm:g}, and 10 % that the loop may overshoot"
        return Envelope(duration, travel, omega * 1.1, setting.control.torque_limit, reserve=reserve)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        return {"output_locked": False, "tau_ext": 0.0, "speed_rpm": self.speed_rpm}

    def steps(self, setting: Setting) -> Steps:
        """Forward, reverse, forward … Each way they begin evenly over half a turn, a wave of the lobes: from one angle
        they would all be wrong by the same, and agree."""
        for k in range(2 * self.repeats):
            omega = self.speed_rpm * RPM * (1.0 if k % 2 == 0 else -1.0)
            sample = yield Torque(0.0)
            end = sample.theta_m + hold_travel(omega, HOLD)
            wanted = HALF_A_TURN * (k // 2) / self.repeats
            beyond = math.copysign(1.0, omega) * (wanted - end) % HALF_A_TURN
            yield from hold_speed(setting, omega, HOLD, beyond)
            yield from self._coast()
        yield from brake(setting)

    def _coast(self) -> Steps:
        """Without torque until it rests, or for PATIENCE where friction is small."""
        sample = yield Torque(0.0)
        begin, rested = sample.t, sample.t
        while sample.t - rested < REST_TIME + PAUSE and sample.t - begin < PATIENCE:
            if abs(sample.omega_m) >= AT_REST:
                rested = sample.t
            sample = yield Torque(0.0)
