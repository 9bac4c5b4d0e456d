"""Whole turns of the output in one direction: what repeats with the output, and lines that lie close together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from rig.control.pid import Pid
from rig.control.profile import Trapezoid
from rig.control.spin import ACCELERATION
from rig.core.errors import UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.core.units import RPM, TURN

WAYS = {"forward": 1.0, "reverse": -1.0}
LEAD = 1.0  # turns of the motor before and after: half a turn is cut at each end, the other half lets the loop settle


@dataclass(frozen=True)
class FullTurn(Procedure):
    """Turn the output slowly through whole turns, one way: the maker's transmission accuracy, orders 2.00 against 2.04

    50 turns of the wave generator a turn of the output: 313 s at 9.6 rpm. A line of the order spectrum is 1/turns wide.
    """

    name: ClassVar[str] = "full_turn"
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l")
    has_reference: ClassVar[bool] = True

    turns: int = 1  # of the output
    speed_rpm: float = 9.6  # of the motor
    direction: str = "forward"  # or "reverse"
    settle: float = 0.5  # s at rest before and after

    def __post_init__(self) -> None:
        if self.direction not in WAYS:
            raise UsageError(f"direction = {self.direction}: expected {' or '.join(WAYS)}")

    def reference(self, ratio: float) -> Trapezoid:
        """Motor angle from where it starts."""
        way = WAYS[self.direction] * TURN * (self.turns * ratio + 2.0 * LEAD)
        return Trapezoid(way, self.speed_rpm * RPM, ACCELERATION)

    def envelope(self, setting: Setting) -> Envelope:
        """Travel is the whole way; the torque is what the position loop may give."""
        wave = self.reference(setting.ratio)
        duration = wave.duration + 2.0 * self.settle
        return Envelope(duration, abs(wave.distance), wave.speed, setting.control.torque_limit)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        speed = WAYS[self.direction] * self.speed_rpm
        return {"output_locked": False, "tau_ext": 0.0, "speed_rpm": speed, "output_turns": self.turns}

    def steps(self, setting: Setting) -> Steps:
        """Hold, turn, hold."""
        pid, wave = Pid(setting.control, setting.period), self.reference(setting.ratio)
        sample = yield Torque(0.0)
        home, end = sample.theta_m, wave.duration + 2.0 * self.settle
        while sample.t < end:
            offset, omega_ref = wave.at(sample.t - self.settle)
            tau = pid.step(home + offset, omega_ref, sample.theta_m, sample.omega_m)
            sample = yield Torque(tau, home + offset, omega_ref)
