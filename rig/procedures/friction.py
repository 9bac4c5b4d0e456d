"""Friction of the whole rig, output free: torque to break away, then torque to keep turning, speed by speed."""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

from rig.control.brake import PATIENCE, brake
from rig.control.pid import Pid
from rig.control.profile import Ramp
from rig.control.spin import ACCELERATION, EASE
from rig.core.errors import NotReady, UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Sample, Torque
from rig.core.units import DEG, RPM, TURN
from rig.procedures.speed_list import speeds_of

MOVED = 0.5 * DEG  # rad of the motor, 14 counts of 10 000: presliding of a gear is a tenth of it
RATE = 0.2  # N·m/s, of the ramp to breakaway: 10 ms from breaking loose to having moved are 2 mN·m
SHARE = 0.4  # of the drive's torque limit, most that breakaway may take
PAUSE = 0.5  # s without torque after it


class Rubbed(NamedTuple):
    """What the procedure itself saw."""

    breakaway: tuple[float, ...]  # N·m, signed, forward and reverse in turn
    plateaus: int
    sentence: str


@dataclass(frozen=True)
class Friction(Procedure):
    """Break away a few times each way, then turn at ± each speed, rising and falling, under the position loop.

    Each speed is held for whole turns of the wave generator, so that what repeats with the angle averages out, and for
    at least `output_deg` of the output. Rising against falling shows whether the lubricant warmed up in between. In
    the run the breakaway ramps have no `theta_ref`.
    """

    name: ClassVar[str] = "friction"
    needs: ClassVar[tuple[str, ...]] = ("t", "theta_m", "theta_l")

    speeds_rpm: str = "5,10,20,50,100,200,300,500"  # of the motor, rising
    output_deg: float = 10.0  # deg of the output at each speed, at least
    seconds: float = 3.0  # s at each speed, at least: friction that wanders with 0.3 s is then averaged over
    breakaways: int = 3  # each way

    def __post_init__(self) -> None:
        speeds = self.speeds
        if len(speeds) < 2 or any(b <= a for a, b in pairwise(speeds)):
            raise UsageError(
                f"speeds_rpm = {self.speeds_rpm}: expected at least two rising speeds in rpm, divided by commas, "
                "for example 5,10,20,50,100,200,300,500"
            )

    @property
    def speeds(self) -> tuple[float, ...]:
        """rpm, slowest first. Raises UsageError when one is no speed."""
        return speeds_of(self.speeds_rpm)

    def staircase(self, ratio: float) -> list[tuple[Ramp, float]]:
        """(ramp to a speed, s held there after it): up and down forward, up and down in reverse, to rest."""
        up = [speed * RPM for speed in self.speeds]
        asked = [*up, *reversed(up), *(-s for s in up), *(-s for s in reversed(up)), 0.0]
        steps, before = [], 0.0
        for omega in asked:
            steps.append((Ramp(before, omega, ACCELERATION), EASE + self.hold(omega, ratio) if omega else 0.0))
            before = omega
        return steps

    def hold(self, omega: float, ratio: float) -> float:
        """s at a speed [rad/s]: whole turns, long enough in time and at the output."""
        turns = max(self.output_deg * ratio / 360.0, abs(omega) * self.seconds / TURN)
        return math.ceil(turns - 1e-9) * TURN / abs(omega)

    def envelope(self, setting: Setting) -> Envelope:
        """Travel is that of the forward half: the reverse half takes it back."""
        stairs = self.staircase(setting.ratio)
        travel, far = 0.0, 0.0
        for ramp, seconds in stairs:
            travel += ramp.travel + ramp.end * seconds
            far = max(far, abs(travel))
        nudge = 2 * self.breakaways * (SHARE * setting.control.torque_limit / RATE + PAUSE)
        duration = nudge + sum(ramp.duration + seconds for ramp, seconds in stairs) + PATIENCE
        fastest = max(self.speeds) * RPM
        reserve = f"the fastest of speeds_rpm = {self.speeds_rpm}, and 10 % that the loop may overshoot"
        return Envelope(duration, far + TURN, fastest * 1.1, setting.control.torque_limit, reserve=reserve)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        return {"output_locked": False, "tau_ext": 0.0, "speeds_rpm": list(self.speeds)}

    def steps(self, setting: Setting) -> Steps:
        """Returns a Rubbed. Raises NotReady when the motor does not break away."""
        found = []
        for k in range(2 * self.breakaways):
            tau = yield from self._break_away(setting, 1.0 if k % 2 == 0 else -1.0)
            found.append(tau)
        yield from self._stairs(setting)
        yield from brake(setting)
        size = sum(map(abs, found)) / max(len(found), 1)
        told = f"breakaway {size:.3f} N·m, mean of {len(found)}; " if found else ""
        plateaus = 4 * len(self.speeds)
        return Rubbed(
            tuple(found), plateaus, f"{told}{plateaus} plateaus, {self.speeds[0]:g} to {self.speeds[-1]:g} rpm"
        )

    def _break_away(self, setting: Setting, way: float) -> Generator[Torque, Sample, float]:
        """The torque [N·m] at which the motor moved, along a slow ramp from none; then none for a moment."""
        sample = yield Torque(0.0)
        home, tau, limit = sample.theta_m, 0.0, SHARE * setting.control.torque_limit
        while way * (sample.theta_m - home) < MOVED:
            tau += RATE * setting.period
            if tau > limit:
                raise NotReady(
                    f"the motor did not move {math.degrees(MOVED):g}° with up to {limit:.2f} N·m: is it blocked?"
                )
            sample = yield Torque(way * tau)
        begin = sample.t
        while sample.t - begin < PAUSE:
            sample = yield Torque(0.0)
        return way * tau

    def _stairs(self, setting: Setting) -> Steps:
        pid = Pid(setting.control, setting.period)
        sample = yield Torque(0.0)
        home, begin = sample.theta_m, sample.t
        for ramp, seconds in self.staircase(setting.ratio):
            if ramp.end:
                setting.note(f"to {ramp.end / RPM:+g} rpm at t = {begin:.3f} s")
            while (t := sample.t - begin) < ramp.duration + seconds:
                offset, omega_ref = ramp.at(t)
                tau = pid.step(home + offset, omega_ref, sample.theta_m, sample.omega_m)
                sample = yield Torque(tau, home + offset, omega_ref)
            home, begin = home + ramp.at(ramp.duration + seconds)[0], begin + ramp.duration + seconds
