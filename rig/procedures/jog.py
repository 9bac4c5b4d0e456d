"""A bounded turn by hand, so to speak: to see that it turns, to bring a mark up, to warm the grease a little."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple

from rig.control.pid import Pid
from rig.control.profile import Trapezoid
from rig.core.errors import UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.core.units import DEG, RPM, TURN

MOST_TURNS = 10.0  # of the motor: a fifth of a turn of the output at 1:50, in sight of whoever jogs
MOST_RPM = 60.0  # of the motor: a turn a second can be followed by eye
ACCELERATION = 10.0  # rad/s²: 60 rpm in 0.6 s
SETTLE = 0.3  # s held before its torque goes off


class Jogged(NamedTuple):
    """How far it came."""

    turned: float  # rad, of the motor
    sentence: str


@dataclass(frozen=True)
class Jog(Procedure):
    """Turn the motor a little, slowly, and stop there: at most 10 turns at 60 rpm

    The position loop starts from the measured angle and ends at rest; backwards with negative turns.
    """

    name: ClassVar[str] = "other"
    label: ClassVar[str] = "jog"
    answers: ClassVar[bool] = True
    checks: ClassVar[bool] = True
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l")
    has_reference: ClassVar[bool] = True

    turns: float = field(default=1.0, metadata={"signed": True})  # of the motor
    speed_rpm: float = 15.0  # of the motor

    def __post_init__(self) -> None:
        if not 0.0 < abs(self.turns) <= MOST_TURNS:
            expected = f"expected up to {MOST_TURNS:g} turns of the motor, either way, and not 0"
            raise UsageError(f"turns = {self.turns:g}: {expected}")
        if not 0.0 < self.speed_rpm <= MOST_RPM:
            raise UsageError(f"speed_rpm = {self.speed_rpm:g}: expected up to {MOST_RPM:g} rpm of the motor")

    @property
    def reference(self) -> Trapezoid:
        """Motor angle from where it starts."""
        return Trapezoid(self.turns * TURN, self.speed_rpm * RPM, ACCELERATION)

    def envelope(self, setting: Setting) -> Envelope:
        """Travel is the turn itself; the torque is what the position loop may give."""
        way = self.reference
        return Envelope(way.duration + SETTLE, abs(way.distance), way.peak, setting.control.torque_limit)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        return {"output_locked": False, "speed_rpm": math.copysign(self.speed_rpm, self.turns), "note": "jog"}

    def steps(self, setting: Setting) -> Steps:
        """Turn, hold for a moment. Returns a Jogged."""
        pid, way = Pid(setting.control, setting.period), self.reference
        sample = yield Torque(0.0)
        home = sample.theta_m
        while sample.t < way.duration + SETTLE:
            offset, omega_ref = way.at(sample.t)
            tau = pid.step(home + offset, omega_ref, sample.theta_m, sample.omega_m)
            sample = yield Torque(tau, home + offset, omega_ref)
        turned = sample.theta_m - home
        return Jogged(turned, f"the motor turned {turned / DEG:+.2f}°, {way.distance / DEG:+.2f}° were asked for")
