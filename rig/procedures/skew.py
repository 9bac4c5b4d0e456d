"""Latch skew: the same turns forth and back at a few speeds, so that reading late shows as what grows with speed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from rig.control.pid import Pid
from rig.control.profile import Trapezoid
from rig.control.spin import ACCELERATION
from rig.core.errors import UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.core.units import RPM, TURN
from rig.procedures.speed_list import speeds_of

REST = 0.3  # s between two legs
SETTLE = 0.5  # s at speed before a row counts, either way: the gear's own swing, 25 Hz at 4 % damping, is over in 0.5 s
FEWEST = 2  # speeds: what grows with speed against what does not
FEWEST_PAIRS = 4  # forth and back: the analysis fits two parameters, and something is left to see their scatter
SLOWEST = 2.0  # rpm: the analysis takes slower legs, below 0.2 rad/s, for standing still
APART = 10.0  # rpm between slowest and fastest: the analysis wants a lever of 1 rad/s


@dataclass(frozen=True)
class Skew(Procedure):
    """Forth and back at each speed, `repeats` times, output free.

    Who reads θ_l later than θ_m by s sees the load ahead by s·ω/N forward and behind by as much in reverse. Friction
    winds the gear up the same way, and is told apart by the torque sensor (its part that grows with speed) and by
    standing still in the difference between speeds (its part that does not).
    """

    name: ClassVar[str] = "other"
    label: ClassVar[str] = "skew"
    needs: ClassVar[tuple[str, ...]] = ("t", "theta_m", "theta_l")
    has_reference: ClassVar[bool] = True

    speeds_rpm: str = "40,120,300"  # of the motor: the lever is the difference between the slowest and the fastest
    turns: int = 3  # of the motor at each speed, at least, once the loop has settled
    seconds: float = 1.0  # s at each speed, at least, once the loop has settled
    repeats: int = 2  # of every speed

    def __post_init__(self) -> None:
        if len(set(self.speeds)) < FEWEST:
            raise UsageError(f"speeds_rpm = {self.speeds_rpm}: expected at least {FEWEST} different speeds in rpm")
        if min(self.speeds) < SLOWEST or max(self.speeds) - min(self.speeds) < APART:
            raise UsageError(
                f"speeds_rpm = {self.speeds_rpm}: expected speeds of at least {SLOWEST:g} rpm, the slowest and the "
                f"fastest at least {APART:g} rpm apart"
            )
        if (pairs := len(self.speeds) * self.repeats) < FEWEST_PAIRS:
            raise UsageError(
                f"repeats = {self.repeats}: {pairs} times forth and back with {len(self.speeds)} speeds, expected at "
                f"least {FEWEST_PAIRS}, which is repeats = {math.ceil(FEWEST_PAIRS / len(self.speeds))}"
            )

    @property
    def speeds(self) -> tuple[float, ...]:
        """rpm. Raises UsageError when one is no speed."""
        return speeds_of(self.speeds_rpm)

    def leg(self, speed_rpm: float) -> Trapezoid:
        """One way at a speed: up to it, settle, whole turns, down."""
        omega = speed_rpm * RPM
        turns = max(self.turns, math.ceil(omega * self.seconds / TURN))
        return Trapezoid(turns * TURN + 2 * omega * SETTLE + omega * omega / ACCELERATION, omega, ACCELERATION)

    def envelope(self, setting: Setting) -> Envelope:
        """Every leg goes back to where it began."""
        legs = [self.leg(speed) for speed in self.speeds]
        duration = 2 * self.repeats * sum(leg.duration + REST for leg in legs) + REST
        fastest = max(self.speeds) * RPM
        return Envelope(duration, max(leg.distance for leg in legs) + 1.0, fastest, setting.control.torque_limit)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        return {"output_locked": False, "tau_ext": 0.0, "speeds_rpm": list(self.speeds)}

    def steps(self, setting: Setting) -> Steps:
        """Leg by leg under one position loop, whose integrator need not start anew each time."""
        pid = Pid(setting.control, setting.period)
        sample = yield Torque(0.0)
        home, begin = sample.theta_m, sample.t
        for speed in self.speeds * self.repeats:
            leg = self.leg(speed)
            setting.note(f"{speed:g} rpm forth and back at t = {begin:.3f} s")
            for direction, start in ((+1, home), (-1, home + leg.distance)):
                while (t := sample.t - begin) < leg.duration + REST:
                    offset, omega = leg.at(t)
                    theta_ref, omega_ref = start + direction * offset, direction * omega
                    tau = pid.step(theta_ref, omega_ref, sample.theta_m, sample.omega_m)
                    sample = yield Torque(tau, theta_ref, omega_ref)
                begin += leg.duration + REST
